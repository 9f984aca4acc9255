// The solids of a run: those of the scene file, and those of the command line fitted into the scene.
#pragma once

#include "samples/viewer/frame_sequence.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/scene_file.hpp"

#include "voile/engine/assets/mesh.hpp"

#include <memory>

namespace viewer
{

struct Solid
{
    std::string name;
    std::variant<voile::engine::Mesh, PlaneShape, SphereShape, CapsuleShape, BoxShape> shape;
    glm::mat4 transform{1.f}; // world from shape, at time 0; of all but a mesh rigid, their scale is in the shape
    std::optional<FrictionEntry> friction{};
    std::optional<MotionEntry> motion{};
    std::shared_ptr<const MeshSequence> frames{}; // of a mesh that deforms, whose shape is the first; else null
    std::optional<MeshSides> sides{};
    uint32_t layers = 1;
    SolidLookEntry look{};
    Location location{};          // in the scene file; line 0: of the command line
    std::filesystem::path file{}; // of the command line

    // A mesh that is flat and level, and stays so: drawn as ground, and no part of the collider box.
    [[nodiscard]] bool is_ground() const;
    // Of a plane or a mesh that is level.
    [[nodiscard]] std::optional<float> ground_height() const;
    // In the scene at time 0. A plane has none.
    [[nodiscard]] std::optional<voile::engine::Bounds> bounds() const;
    // Of all shapes that it takes, at all poses of its spin and sway. Its velocity is left out.
    [[nodiscard]] std::optional<voile::engine::Bounds> swept_bounds() const;
};

// Loads all meshes. The files of --collider replace the scene's meshes (its ground stays): each is scaled evenly,
// centered and set on the floor of the box around the replaced meshes, several side by side. In a scene without such a
// mesh the box lies below the cloths. Motion and layers are those of the first replaced mesh; they do not deform.
// Errors name the file.
voile::Result<std::vector<Solid>> load_solids(const SceneFile& scene, const Options& options);

voile::engine::Bounds merge(const std::optional<voile::engine::Bounds>& a, const voile::engine::Bounds& b);

} // namespace viewer
