// Graphics pipelines for dynamic rendering: triangles, dynamic viewport and scissor.
#pragma once

#include "gpu/owned.hpp"

#include "voile/gpu/context.hpp"

#include <span>

namespace voile::engine
{

// One vertex buffer that feeds one attribute. Binding and location are its index in the list.
struct VertexStream
{
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t stride = 0; // bytes
    VkVertexInputRate rate = VK_VERTEX_INPUT_RATE_VERTEX;
};

struct GraphicsPipelineDescription
{
    const char* name = nullptr;
    std::span<const uint32_t> vertex;
    std::span<const uint32_t> fragment{}; // empty: depth only
    std::span<const VertexStream> streams{};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkFormat color_format = VK_FORMAT_UNDEFINED;
    VkFormat depth_format = VK_FORMAT_UNDEFINED;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkCompareOp depth_compare = VK_COMPARE_OP_LESS;
    bool depth_write = true;
    float depth_bias = 0; // constant factor; the slope factor is half of it
    bool wires = false;   // the edges of the triangles alone; the device must draw wires (Device::draws_wires)
    bool blend = false;   // over what is there, by the color's alpha
};

// StartupError when the driver refuses.
Owned<VkPipeline> create_graphics_pipeline(const gpu::Context& context, const GraphicsPipelineDescription& description);

} // namespace voile::engine
