// PassView: the View that components draw into while one of the renderer's passes is recorded.
#pragma once

#include "voile/engine/scene/component.hpp"

#include "voile/gpu/context.hpp"

namespace voile::engine
{

class ScenePipelines;

class PassView : public View
{
public:
    struct Pass
    {
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkPipeline surfaces = VK_NULL_HANDLE;
        VkPipeline wires = VK_NULL_HANDLE; // drawn over surfaces other than the ground; null: none
        ScenePipelines* marks = nullptr;   // null if the pass draws none
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
