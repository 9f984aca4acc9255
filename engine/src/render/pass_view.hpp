// PassView: the View that components draw into while one of the renderer's passes is recorded.
#pragma once

#include "gpu/owned.hpp"
#include "voile/engine/scene/component.hpp"

#include "voile/gpu/context.hpp"

namespace voile::engine
{

struct VertexStream;

// The pipelines of lines and dots. Created on first use, because a normal run draws none.
class MarkPipelines
{
public:
    MarkPipelines(const gpu::Context& context, VkPipelineLayout layout, VkFormat color, VkFormat depth,
                  VkSampleCountFlagBits samples)
        : context_(context), layout_(layout), color_(color), depth_(depth), samples_(samples)
    {
    }

    VkPipeline lines(); // StartupError when the driver refuses
    VkPipeline dots(bool flag_words);

private:
    Owned<VkPipeline> create(const char* name, std::span<const uint32_t> vertex, const VertexStream& second) const;

    const gpu::Context& context_;
    VkPipelineLayout layout_;
    VkFormat color_;
    VkFormat depth_;
    VkSampleCountFlagBits samples_;
    Owned<VkPipeline> lines_;
    Owned<VkPipeline> dots_;
    Owned<VkPipeline> flagged_dots_;
};

class PassView : public View
{
public:
    struct Pass
    {
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkPipeline surfaces = VK_NULL_HANDLE;
        VkPipeline wires = VK_NULL_HANDLE; // drawn over surfaces other than the ground; null: none
        MarkPipelines* marks = nullptr;    // null if the pass draws none
        VkExtent2D extent{};
    };

    PassView(Kind kind, const glm::mat4& clip_from_world, const gpu::Context& context, const Pass& pass)
        : View(kind, clip_from_world), context_(context), pass_(pass)
    {
    }

    void draw(VkCommandBuffer cmd, const Drawable& drawable) override;
    void draw(VkCommandBuffer cmd, const Lines& lines) override;
    void draw(VkCommandBuffer cmd, const Dots& dots) override;

private:
    struct Marks; // the common part of lines and dots
    void draw_marks(VkCommandBuffer cmd, VkPipeline pipeline, const Marks& marks);
    void bind(VkCommandBuffer cmd, VkPipeline pipeline);

    const gpu::Context& context_;
    Pass pass_;
    VkPipeline bound_ = VK_NULL_HANDLE;
};

} // namespace voile::engine
