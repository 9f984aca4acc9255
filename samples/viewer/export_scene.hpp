// What a run exports: its cloths, and its solids as meshes, where they are at any time.
#pragma once

#include "samples/viewer/run_statistics.hpp"
#include "samples/viewer/stage.hpp"
#include "samples/viewer/usd_writer.hpp"

#include <optional>

namespace viewer
{

struct ExportObject
{
    Surface surface; // at time 0
    SurfaceMotion motion = SurfaceMotion::still;
    std::optional<size_t> solid{}; // its number; a cloth has none
};

// A solid at time 0 in its own space. A formula shape becomes a mesh, a plane a large square. `extent`: m, of the
// scene.
voile::engine::Mesh mesh_of(const Solid& solid, float extent);

// The cloths, then the solids if any export has them.
class ExportScene
{
public:
    // `start`: the state before the first step; empty if only surfaces() is called. `extent`: m, of the scene. The
    // solids are borrowed.
    ExportScene(const Stage& stage, const std::vector<Solid>& solids, const std::vector<FinalCloth>& start,
                float extent, const Options& options);

    [[nodiscard]] const std::vector<ExportObject>& objects() const { return objects_; }

    // Of an object that moves rigidly, from time 0 to `seconds`.
    [[nodiscard]] glm::mat4 pose(const ExportObject& object, double seconds) const;
    // Of a solid at `seconds`.
    [[nodiscard]] std::vector<glm::vec3> positions(const ExportObject& object, double seconds) const;
    // Every object at the end of a run of `seconds`.
    [[nodiscard]] std::vector<Surface> surfaces(const std::vector<FinalCloth>& state, double seconds) const;

private:
    const std::vector<Solid>& solids_;
    std::vector<ExportObject> objects_;
};

} // namespace viewer
