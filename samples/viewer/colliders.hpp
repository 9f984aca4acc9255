// The solids of a run: those of the scene file, and those of the command line fitted into the scene.
#pragma once

#include "samples/viewer/options.hpp"
#include "samples/viewer/scene_file.hpp"

#include "engine/assets/mesh.hpp"

namespace viewer
{

struct Solid
{
    std::string name;
    std::variant<engine::Mesh, PlaneShape, SphereShape> shape;
    glm::mat4 transform{1.f}; // of a mesh
    std::optional<FrictionEntry> friction;

    // A mesh that is flat and level: drawn as ground, and no part of the collider box.
    [[nodiscard]] bool is_ground() const;
    // Of meshes and spheres, in the scene. A plane has none.
    [[nodiscard]] std::optional<engine::Bounds> bounds() const;
};

// Loads all meshes. The files of --collider take the place of the scene's meshes (its ground stays): each is scaled
// evenly, centred and set on the floor of the box that those filled, side by side where there are several. In a scene
// without such a mesh the box lies below the cloths. Errors name the file.
gpu::Result<std::vector<Solid>> load_solids(const SceneFile& scene, const Options& options);

engine::Bounds merge(const std::optional<engine::Bounds>& a, const engine::Bounds& b);

} // namespace viewer
