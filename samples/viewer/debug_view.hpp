// --debug: what the solver works with, drawn over the picture.
#pragma once

#include "samples/viewer/stage.hpp"

namespace viewer
{

// Boxes of the hierarchies of mesh colliders, moving with them (of one that deforms a note that there are none);
// vertices that touch a collider; vertex normals; vertices of edges and triangles that intersect. All but the boxes are
// drawn from the solver's own buffers. Lives as long as the stage's solver and motions.
class DebugView : public voile::engine::Component
{
public:
    DebugView(voile::engine::App& app, const Stage& stage, const std::vector<Solid>& solids,
              const DebugOptions& options);

    [[nodiscard]] const DebugOptions& options() const { return options_; }
    // What is drawn from the next frame on. Another level of boxes waits for the frames in flight.
    void set_options(const DebugOptions& options);

    void record_draw(VkCommandBuffer cmd, voile::engine::View& view) override;

private:
    struct Boxes // of one solid
    {
        size_t solid = 0;
        voile::gpu::Buffer from; // of their edges
        voile::gpu::Buffer to;
        uint32_t edges = 0;
    };
    struct Cloth
    {
        voile::ClothId id;
        float normal_length = 0; // m
    };

    void add_boxes(size_t solid, uint32_t level);

    voile::engine::App& app_;
    const Stage& stage_;
    const std::vector<Solid>& solids_;
    voile::component::ClothWorld& world_;
    const Motions& motions_;
    DebugOptions options_;
    std::vector<Boxes> boxes_;
    std::vector<Cloth> cloths_;
};

} // namespace viewer
