// Overlay: its pipeline, and per slot the buffers that hold a frame's triangles.
#include "voile/engine/render/overlay.hpp"

#include "render/graphics_pipeline.hpp"

#include "voile/gpu/buffer.hpp"
#include "voile/gpu/recorder.hpp"

#include "shaders/render/render_layout.h"
#include "voile_engine_shaders.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

namespace voile::engine
{

namespace
{

// The three attributes of an OverlayVertex, which lie in one buffer.
constexpr std::array<VertexStream, 3> k_streams{{{VK_FORMAT_R32G32_SFLOAT, sizeof(OverlayVertex)},
                                                 {VK_FORMAT_R32G32_SFLOAT, sizeof(OverlayVertex)},
                                                 {VK_FORMAT_R8G8B8A8_UNORM, sizeof(OverlayVertex)}}};
constexpr std::array<VkDeviceSize, 3> k_offsets{offsetof(OverlayVertex, position), offsetof(OverlayVertex, coordinate),
                                                offsetof(OverlayVertex, color)};

constexpr VkPipelineStageFlags2KHR k_color_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT_KHR;
constexpr VkAccessFlags2KHR k_color_access =
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT_KHR | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT_KHR;

Owned<VkSampler> create_sampler(const gpu::Context& context)
{
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    VkSampler sampler = VK_NULL_HANDLE;
    check(context.fn.vkCreateSampler(context.device(), &info, nullptr, &sampler), "overlay sampler");
    return {context.device(), sampler, context.fn.vkDestroySampler};
}

Owned<VkDescriptorSetLayout> create_set_layout(const gpu::Context& context, const VkSampler* sampler)
{
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, sampler};
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = 1;
    info.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(context.fn.vkCreateDescriptorSetLayout(context.device(), &info, nullptr, &layout), "overlay bindings");
    return {context.device(), layout, context.fn.vkDestroyDescriptorSetLayout};
}

Owned<VkPipelineLayout> create_layout(const gpu::Context& context, const VkDescriptorSetLayout* set_layout)
{
    const VkPushConstantRange push{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(shared::OverlayPush)};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = set_layout;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(context.fn.vkCreatePipelineLayout(context.device(), &info, nullptr, &layout), "overlay bindings");
    return {context.device(), layout, context.fn.vkDestroyPipelineLayout};
}

Owned<VkDescriptorPool> create_pool(const gpu::Context& context)
{
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = 1;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(context.fn.vkCreateDescriptorPool(context.device(), &info, nullptr, &pool), "overlay bindings");
    return {context.device(), pool, context.fn.vkDestroyDescriptorPool};
}

// A slot's buffer, made larger if it is too small.
void write(const gpu::Context& context, gpu::Buffer& buffer, std::span<const std::byte> bytes, VkBufferUsageFlags usage)
{
    if (buffer.size() < bytes.size())
        buffer = take(gpu::create_buffer(context, "overlay", bytes.size() + bytes.size() / 2, usage, Memory::upload));
    std::copy(bytes.begin(), bytes.end(), buffer.mapped().begin());
    buffer.flush();
}

VkRect2D clipped(const VkRect2D& rectangle, VkExtent2D extent)
{
    const auto width = static_cast<int64_t>(extent.width);
    const auto height = static_cast<int64_t>(extent.height);
    const int64_t left = std::clamp<int64_t>(rectangle.offset.x, 0, width);
    const int64_t top = std::clamp<int64_t>(rectangle.offset.y, 0, height);
    const int64_t right = std::clamp<int64_t>(int64_t{rectangle.offset.x} + rectangle.extent.width, left, width);
    const int64_t bottom = std::clamp<int64_t>(int64_t{rectangle.offset.y} + rectangle.extent.height, top, height);
    return {{static_cast<int32_t>(left), static_cast<int32_t>(top)},
            {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
}

} // namespace

struct Overlay::State
{
    struct Slot
    {
        gpu::Buffer vertices;
        gpu::Buffer indices;
    };

    const gpu::Context& context;
    Image coverage;
    std::optional<gpu::Buffer> staging; // of the coverage, until the first record
    gpu::Buffer staged;                 // read by the command buffer of the first record
    Owned<VkSampler> sampler;
    Owned<VkDescriptorSetLayout> set_layout;
    Owned<VkPipelineLayout> layout;
    Owned<VkDescriptorPool> pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
    Owned<VkPipeline> pipeline;
    std::vector<Slot> slots;

    State(const Device& device, uint32_t slot_count, VkFormat format, const Coverage& wanted);
    void write_set();
    void upload_coverage(VkCommandBuffer cmd);
    void draw(VkCommandBuffer cmd, VkExtent2D extent, const Slot& slot, const OverlayTriangles& triangles) const;
};

Overlay::State::State(const Device& device, uint32_t slot_count, VkFormat format, const Coverage& wanted)
    : context(device.context()),
      coverage(device, {.name = "overlay coverage",
                        .format = VK_FORMAT_R8_UNORM,
                        .extent = wanted.extent,
                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT}),
      sampler(create_sampler(context)), set_layout(create_set_layout(context, sampler.address())),
      layout(create_layout(context, set_layout.address())), pool(create_pool(context)), slots(slot_count)
{
    staging = take(gpu::create_buffer(context, "overlay staging", wanted.pixels.size(),
                                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
    std::copy(wanted.pixels.begin(), wanted.pixels.end(), staging->mapped().begin());
    staging->flush();
    write_set();
    pipeline = create_graphics_pipeline(context, {.name = "overlay",
                                                  .vertex = shaders::k_overlay_vert,
                                                  .fragment = shaders::k_overlay_frag,
                                                  .streams = k_streams,
                                                  .layout = layout.get(),
                                                  .color_format = format,
                                                  .depth_write = false,
                                                  .blend = true});
}

void Overlay::State::write_set()
{
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool.get();
    info.descriptorSetCount = 1;
    info.pSetLayouts = set_layout.address();
    check(context.fn.vkAllocateDescriptorSets(context.device(), &info, &set), "overlay bindings");
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, coverage.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    context.fn.vkUpdateDescriptorSets(context.device(), 1, &write, 0, nullptr);
}

void Overlay::State::upload_coverage(VkCommandBuffer cmd)
{
    if (!staging)
        return;
    record_transition(context, cmd, coverage.handle(), coverage.aspect(),
                      {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_PIPELINE_STAGE_2_COPY_BIT_KHR, 0, VK_PIPELINE_STAGE_2_COPY_BIT_KHR,
                       VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR});
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {coverage.extent().width, coverage.extent().height, 1};
    context.fn.vkCmdCopyBufferToImage(cmd, staging->handle(), coverage.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                      1, &region);
    record_transition(context, cmd, coverage.handle(), coverage.aspect(),
                      {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                       VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT_KHR});
    staged = std::move(*staging);
    staging.reset();
}

void Overlay::State::draw(VkCommandBuffer cmd, VkExtent2D extent, const Slot& slot,
                          const OverlayTriangles& triangles) const
{
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const shared::OverlayPush push{2.f / glm::vec2(extent.width, extent.height)};
    const std::array buffers{slot.vertices.handle(), slot.vertices.handle(), slot.vertices.handle()};
    context.fn.vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.get());
    context.fn.vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout.get(), 0, 1, &set, 0, nullptr);
    context.fn.vkCmdPushConstants(cmd, layout.get(), VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(push), &push);
    context.fn.vkCmdSetViewport(cmd, 0, 1, &viewport);
    context.fn.vkCmdBindVertexBuffers(cmd, 0, static_cast<uint32_t>(buffers.size()), buffers.data(), k_offsets.data());
    context.fn.vkCmdBindIndexBuffer(cmd, slot.indices.handle(), 0, VK_INDEX_TYPE_UINT16);
    for (const OverlayPart& part : triangles.parts)
    {
        const VkRect2D scissor = clipped(part.scissor, extent);
        if (scissor.extent.width == 0 || scissor.extent.height == 0)
            continue;
        context.fn.vkCmdSetScissor(cmd, 0, 1, &scissor);
        context.fn.vkCmdDrawIndexed(cmd, part.index_count, 1, part.first_index, part.vertex_offset, 0);
    }
}

Overlay::Overlay(const Device& device, uint32_t slots, VkFormat format, const Coverage& coverage)
    : state_(std::make_unique<State>(device, slots, format, coverage))
{
}

Overlay::~Overlay() = default;

void Overlay::record(VkCommandBuffer cmd, const Image& target, uint32_t slot, const OverlayTriangles& triangles)
{
    if (triangles.parts.empty())
        return;
    State& state = *state_;
    const gpu::Context& context = state.context;
    const gpu::LabelScope scope(context, cmd, "overlay");
    state.upload_coverage(cmd);
    State::Slot& buffers = state.slots[slot];
    write(context, buffers.vertices, std::as_bytes(std::span(triangles.vertices)), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    write(context, buffers.indices, std::as_bytes(std::span(triangles.indices)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);

    record_transition(context, cmd, target.handle(), target.aspect(),
                      {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR, 0, k_color_stage, k_color_access});
    VkRenderingAttachmentInfoKHR color{};
    color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO_KHR;
    color.imageView = target.view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfoKHR rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO_KHR;
    rendering.renderArea.extent = target.extent();
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    context.fn.vkCmdBeginRenderingKHR(cmd, &rendering);
    state.draw(cmd, target.extent(), buffers, triangles);
    context.fn.vkCmdEndRenderingKHR(cmd);
    record_transition(context, cmd, target.handle(), target.aspect(),
                      {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_color_stage,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                       VK_ACCESS_2_TRANSFER_READ_BIT_KHR});
}

} // namespace voile::engine
