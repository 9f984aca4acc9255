// FrameBindings: layouts, pool, sets and uniform buffers.
#include "render/frame_bindings.hpp"

#include <array>
#include <cstring>

namespace voile::engine
{

namespace
{

// Beyond the map there is nothing.
Owned<VkSampler> create_map_sampler(const gpu::Context& context, bool compares)
{
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = info.minFilter = compares ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE; // the far plane
    info.compareEnable = compares ? VK_TRUE : VK_FALSE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    VkSampler sampler = VK_NULL_HANDLE;
    check(context.fn.vkCreateSampler(context.device(), &info, nullptr, &sampler), "sampler of maps");
    return {context.device(), sampler, context.fn.vkDestroySampler};
}

} // namespace

FrameBindings::FrameBindings(const Device& device, uint32_t slots, VkImageView shadow_map, VkImageView height_map)
    : context_(device.context()), comparing_(create_map_sampler(context_, true)),
      reading_(create_map_sampler(context_, false))
{
    create_layouts();
    create_sets(slots, {shadow_map, shadow_map, height_map});
}

void FrameBindings::create_layouts()
{
    const auto map = [](uint32_t binding, const Owned<VkSampler>& sampler)
    {
        return VkDescriptorSetLayoutBinding{binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                            VK_SHADER_STAGE_FRAGMENT_BIT, sampler.address()};
    };
    const std::array<VkDescriptorSetLayoutBinding, 1 + k_maps> bindings{
        {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, k_stages, nullptr},
         map(1, comparing_),
         map(2, reading_),
         map(3, reading_)}};
    VkDescriptorSetLayoutCreateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set_info.bindingCount = static_cast<uint32_t>(bindings.size());
    set_info.pBindings = bindings.data();
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    check(context_.fn.vkCreateDescriptorSetLayout(context_.device(), &set_info, nullptr, &set_layout),
          "frame bindings");
    set_layout_ = {context_.device(), set_layout, context_.fn.vkDestroyDescriptorSetLayout};

    const VkPushConstantRange push{k_stages, 0, sizeof(shared::DrawPush)};
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 1;
    info.pSetLayouts = set_layout_.address();
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &push;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(context_.fn.vkCreatePipelineLayout(context_.device(), &info, nullptr, &layout), "frame bindings");
    layout_ = {context_.device(), layout, context_.fn.vkDestroyPipelineLayout};
}

void FrameBindings::create_sets(uint32_t slots, const std::array<VkImageView, k_maps>& maps)
{
    const std::array<VkDescriptorPoolSize, 2> sizes{
        {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, slots}, {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, k_maps * slots}}};
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = slots;
    pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(context_.fn.vkCreateDescriptorPool(context_.device(), &pool_info, nullptr, &pool), "frame bindings");
    pool_ = {context_.device(), pool, context_.fn.vkDestroyDescriptorPool};

    const std::vector<VkDescriptorSetLayout> layouts(slots, set_layout_.get());
    VkDescriptorSetAllocateInfo set_info{};
    set_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set_info.descriptorPool = pool;
    set_info.descriptorSetCount = slots;
    set_info.pSetLayouts = layouts.data();
    sets_.resize(slots);
    check(context_.fn.vkAllocateDescriptorSets(context_.device(), &set_info, sets_.data()), "frame bindings");

    for (const VkDescriptorSet set : sets_)
    {
        uniforms_.push_back(take(gpu::create_buffer(context_, "frame uniforms", sizeof(shared::FrameUniforms),
                                                    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, Memory::upload)));
        const VkDescriptorBufferInfo buffer{uniforms_.back().handle(), 0, VK_WHOLE_SIZE};
        std::array<VkDescriptorImageInfo, k_maps> images{};
        std::array<VkWriteDescriptorSet, 1 + k_maps> writes{};
        for (uint32_t i = 0; i < writes.size(); ++i)
        {
            writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
            writes[i].dstSet = set;
            writes[i].dstBinding = i;
            writes[i].descriptorCount = 1;
            writes[i].descriptorType =
                i == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
            if (i == 0)
                writes[i].pBufferInfo = &buffer;
            else
            {
                images[i - 1] = {VK_NULL_HANDLE, maps[i - 1], VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
                writes[i].pImageInfo = &images[i - 1];
            }
        }
        context_.fn.vkUpdateDescriptorSets(context_.device(), static_cast<uint32_t>(writes.size()), writes.data(), 0,
                                           nullptr);
    }
}

void FrameBindings::bind(VkCommandBuffer cmd, uint32_t slot, const shared::FrameUniforms& uniforms)
{
    std::memcpy(uniforms_[slot].mapped().data(), &uniforms, sizeof(uniforms));
    uniforms_[slot].flush();
    context_.fn.vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.get(), 0, 1, &sets_[slot], 0,
                                        nullptr);
}

} // namespace voile::engine
