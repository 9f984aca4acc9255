// FrameBindings: the descriptor sets of the renderer's shaders, one per frame slot, written once.
#pragma once

#include "gpu/owned.hpp"
#include "voile/engine/gpu/device.hpp"

#include "voile/gpu/buffer.hpp"

#include "shaders/render/render_layout.h"

#include <array>
#include <vector>

namespace voile::engine
{

class FrameBindings
{
public:
    // Binding 0: FrameUniforms of the slot. 1: `shadow_map`, compared with bilinear filtering. 2, 3: the depths of
    // `shadow_map` and `height_map`. Both in DEPTH_STENCIL_READ_ONLY_OPTIMAL. StartupError if they cannot be made.
    FrameBindings(const Device& device, uint32_t slots, VkImageView shadow_map, VkImageView height_map);

    // One set, and push constants of a DrawPush for vertex and fragment shaders.
    [[nodiscard]] VkPipelineLayout layout() const { return layout_.get(); }
    static constexpr VkShaderStageFlags k_stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT; // of both

    // Writes the slot's uniforms and binds its set. The slot's previous use must have completed.
    void bind(VkCommandBuffer cmd, uint32_t slot, const shared::FrameUniforms& uniforms);

private:
    static constexpr uint32_t k_maps = 3; // bindings of images

    void create_layouts();
    void create_sets(uint32_t slots, const std::array<VkImageView, k_maps>& maps);

    const gpu::Context& context_;
    Owned<VkSampler> comparing_;
    Owned<VkSampler> reading_;
    Owned<VkDescriptorSetLayout> set_layout_;
    Owned<VkPipelineLayout> layout_;
    Owned<VkDescriptorPool> pool_;
    std::vector<gpu::Buffer> uniforms_;
    std::vector<VkDescriptorSet> sets_;
};

} // namespace voile::engine
