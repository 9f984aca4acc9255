// The cloth module as components of the engine. No other code uses both.
#pragma once

#include "voile/solver.hpp"

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/upload.hpp"
#include "voile/engine/scene/scene.hpp"

#include <memory>
#include <vector>

namespace voile::component
{

// Owns the solver and records its passes. A scene has one, added before the Sheets that use it. All sheets share it and
// its dispatches.
class ClothWorld : public engine::Component
{
public:
    // `slots`: frames in flight. StartupError if the device does not meet the module's requirements.
    ClothWorld(const engine::Device& device, uint32_t slots, const SolverOptions& options = {});

    [[nodiscard]] Solver& solver() { return solver_; }

    // Gravity, wind and substeps of every step. Duration and time are the frame's. May be changed between frames. If
    // the solver refuses a step, the frame throws StartupError.
    Step step;
    bool collect_statistics = false; // reduce statistics each frame, into the frame's slot
    // Counted with the statistics of each frame; needs SolverOptions::intersections.
    Intersections intersections = Intersections::not_counted;

    // Adds a collider, or throws StartupError with the reason.
    template <typename Collider>
    ColliderId add_collider(const Collider& collider)
    {
        return engine::take(solver_.add_collider(collider));
    }

    void record_compute(VkCommandBuffer cmd, const engine::FrameInfo& frame) override;

private:
    Solver solver_;
    std::vector<Upload> uploads_; // one per slot
};

// Draws one cloth from the buffers that the solver writes.
class Sheet : public engine::Component
{
public:
    // Draws a cloth that was added to the world's solver.
    Sheet(ClothWorld& world, engine::UploadBatch& uploads, ClothId cloth, const engine::Surface& surface);
    // Adds `grid` to the world first, or throws StartupError with the reason.
    Sheet(ClothWorld& world, engine::UploadBatch& uploads, const GridCloth& grid, const engine::Surface& surface);

    [[nodiscard]] ClothId cloth() const { return cloth_; }
    // From the next frame on.
    void set_surface(const engine::Surface& surface) { surface_ = surface; }

    void record_draw(VkCommandBuffer cmd, engine::View& view) override;

private:
    ClothWorld& world_;
    ClothId cloth_;
    engine::Surface surface_;
    gpu::Buffer texture_coordinates_;
    gpu::Buffer indices_;
    uint32_t index_count_ = 0;
};

// A two-sided woven surface in the given colors (linear), for a cloth whose longer side is `size` m. Its check repeats
// ten times along that side at any scale of the scene.
engine::Surface fabric_surface(const glm::vec3& color, const glm::vec3& back_color, float size);

} // namespace voile::component
