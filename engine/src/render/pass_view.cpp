// Drawing surfaces, lines and dots.
#include "render/pass_view.hpp"

#include "render/frame_bindings.hpp"
#include "render/scene_pipelines.hpp"

#include "voile/gpu/recorder.hpp"

#include "shaders/render/render_layout.h"

#include <array>

namespace voile::engine
{

struct PassView::Marks
{
    shared::MarkPush push;
    std::array<VkBuffer, 2> buffers;
    std::array<VkDeviceSize, 2> offsets;
    uint32_t count;
    const char* label;
};

void PassView::bind(VkCommandBuffer cmd, VkPipeline pipeline)
{
    if (pipeline != bound_)
        context_.fn.vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    bound_ = pipeline;
}

void PassView::draw(VkCommandBuffer cmd, const Drawable& drawable)
{
    const gpu::LabelScope scope(context_, cmd, drawable.label);
    bind(cmd, pass_.surfaces);
    const Surface& surface = drawable.surface;
    const shared::DrawPush push{drawable.model,
                                surface.base_color,
                                surface.roughness,
                                surface.two_sided ? surface.back_color : surface.base_color,
                                surface.metallic,
                                surface.sheen,
                                surface.weave_scale,
                                surface.pattern_scale,
                                static_cast<uint32_t>(surface.kind),
                                surface.translucency,
                                static_cast<uint32_t>(surface.weave),
                                static_cast<uint32_t>(surface.pattern)};
    context_.fn.vkCmdPushConstants(cmd, pass_.layout, FrameBindings::k_stages, 0, sizeof(push), &push);
    const std::array buffers{drawable.positions, drawable.normals, drawable.texture_coordinates};
    const std::array offsets{drawable.position_offset, drawable.normal_offset, drawable.texture_coordinate_offset};
    const uint32_t streams = kind() == Kind::shadow ? 1 : 3;
    context_.fn.vkCmdBindVertexBuffers(cmd, 0, streams, buffers.data(), offsets.data());
    context_.fn.vkCmdBindIndexBuffer(cmd, drawable.indices, drawable.index_offset, VK_INDEX_TYPE_UINT32);
    context_.fn.vkCmdDrawIndexed(cmd, drawable.index_count, 1, 0, 0, 0);
    if (pass_.wires == VK_NULL_HANDLE || surface.kind == Surface::Kind::ground)
        return;
    bind(cmd, pass_.wires);
    context_.fn.vkCmdDrawIndexed(cmd, drawable.index_count, 1, 0, 0, 0);
}

void PassView::draw_marks(VkCommandBuffer cmd, VkPipeline pipeline, const Marks& marks)
{
    const gpu::LabelScope scope(context_, cmd, marks.label);
    bind(cmd, pipeline);
    shared::MarkPush push = marks.push;
    push.pixel = 2.f / glm::vec2(pass_.extent.width, pass_.extent.height);
    context_.fn.vkCmdPushConstants(cmd, pass_.layout, FrameBindings::k_stages, 0, sizeof(push), &push);
    context_.fn.vkCmdBindVertexBuffers(cmd, 0, static_cast<uint32_t>(marks.buffers.size()), marks.buffers.data(),
                                       marks.offsets.data());
    context_.fn.vkCmdDraw(cmd, 6, marks.count, 0, 0); // two triangles per mark
}

void PassView::draw(VkCommandBuffer cmd, const Lines& lines)
{
    if (pass_.marks == nullptr || lines.count == 0)
        return;
    const shared::MarkPush push{lines.model, lines.color, lines.width, {}, lines.length, 0};
    draw_marks(cmd, pass_.marks->lines(),
               {push, {lines.from, lines.to}, {lines.from_offset, lines.to_offset}, lines.count, lines.label});
}

void PassView::draw(VkCommandBuffer cmd, const Dots& dots)
{
    if (pass_.marks == nullptr || dots.count == 0)
        return;
    const shared::MarkPush push{dots.model, dots.color, dots.size, {}, 0, dots.mask};
    draw_marks(cmd, pass_.marks->dots(dots.flag_words),
               {push, {dots.positions, dots.flags}, {dots.position_offset, dots.flag_offset}, dots.count, dots.label});
}

} // namespace voile::engine
