// Builds a graphics pipeline from the few settings that differ between the renderer's pipelines.
#include "render/graphics_pipeline.hpp"

#include "voile/engine/gpu/device.hpp"

#include <array>
#include <vector>

namespace voile::engine
{

namespace
{

Owned<VkShaderModule> create_module(const gpu::Context& context, const char* name, std::span<const uint32_t> spirv)
{
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    check(context.fn.vkCreateShaderModule(context.device(), &info, nullptr, &module), name);
    return {context.device(), module, context.fn.vkDestroyShaderModule};
}

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module)
{
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    return info;
}

struct VertexInput
{
    std::vector<VkVertexInputBindingDescription> bindings;
    std::vector<VkVertexInputAttributeDescription> attributes;

    explicit VertexInput(std::span<const VertexStream> streams)
    {
        for (uint32_t i = 0; i < streams.size(); ++i)
        {
            bindings.push_back({i, streams[i].stride, streams[i].rate});
            attributes.push_back({i, i, streams[i].format, 0});
        }
    }

    [[nodiscard]] VkPipelineVertexInputStateCreateInfo info() const
    {
        VkPipelineVertexInputStateCreateInfo result{};
        result.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        result.vertexBindingDescriptionCount = static_cast<uint32_t>(bindings.size());
        result.pVertexBindingDescriptions = bindings.data();
        result.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size());
        result.pVertexAttributeDescriptions = attributes.data();
        return result;
    }
};

// The create infos that point to each other. Lives while the pipeline is made.
struct FixedState
{
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkPipelineViewportStateCreateInfo viewport{};
    VkPipelineRasterizationStateCreateInfo raster{};
    VkPipelineMultisampleStateCreateInfo multisample{};
    VkPipelineDepthStencilStateCreateInfo depth{};
    VkPipelineColorBlendAttachmentState attachment{};
    VkPipelineColorBlendStateCreateInfo blend{};
    std::array<VkDynamicState, 2> dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{};

    explicit FixedState(const GraphicsPipelineDescription& description)
    {
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = 1;
        viewport.scissorCount = 1;
        raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        raster.polygonMode = description.wires ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
        raster.cullMode = VK_CULL_MODE_NONE; // cloth has two sides, and user meshes may be open or inside out
        raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        raster.lineWidth = 1;
        raster.depthBiasEnable = description.depth_bias != 0 ? VK_TRUE : VK_FALSE;
        raster.depthBiasConstantFactor = description.depth_bias;
        raster.depthBiasSlopeFactor = 0.5f * description.depth_bias;
        multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        multisample.rasterizationSamples = description.samples;
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = description.depth_format != VK_FORMAT_UNDEFINED ? VK_TRUE : VK_FALSE;
        depth.depthWriteEnable = description.depth_write ? VK_TRUE : VK_FALSE;
        depth.depthCompareOp = description.depth_compare;
        attachment.colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
        attachment.blendEnable = description.blend ? VK_TRUE : VK_FALSE;
        attachment.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        attachment.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
        blend.attachmentCount = description.color_format != VK_FORMAT_UNDEFINED ? 1 : 0;
        blend.pAttachments = &attachment;
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = static_cast<uint32_t>(dynamic_states.size());
        dynamic.pDynamicStates = dynamic_states.data();
    }
    FixedState(const FixedState&) = delete;
    FixedState& operator=(const FixedState&) = delete;
};

} // namespace

Owned<VkPipeline> create_graphics_pipeline(const gpu::Context& context, const GraphicsPipelineDescription& description)
{
    const Owned<VkShaderModule> vertex = create_module(context, description.name, description.vertex);
    Owned<VkShaderModule> fragment;
    // Constant 0 of fragment shaders that have one (shaders/render/frame.glsl).
    const VkBool32 is_cpu = context.device_type == VK_PHYSICAL_DEVICE_TYPE_CPU ? VK_TRUE : VK_FALSE;
    const VkSpecializationMapEntry entry{0, 0, sizeof(is_cpu)};
    const VkSpecializationInfo constants{1, &entry, sizeof(is_cpu), &is_cpu};
    std::vector<VkPipelineShaderStageCreateInfo> stages{stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex.get())};
    if (!description.fragment.empty())
    {
        fragment = create_module(context, description.name, description.fragment);
        stages.push_back(stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get()));
        stages.back().pSpecializationInfo = &constants;
    }
    const VertexInput input(description.streams);
    const VkPipelineVertexInputStateCreateInfo input_info = input.info();
    const FixedState fixed(description);

    VkPipelineRenderingCreateInfoKHR rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO_KHR;
    rendering.colorAttachmentCount = fixed.blend.attachmentCount;
    rendering.pColorAttachmentFormats = &description.color_format;
    rendering.depthAttachmentFormat = description.depth_format;
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &rendering;
    info.stageCount = static_cast<uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &input_info;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.viewport;
    info.pRasterizationState = &fixed.raster;
    info.pMultisampleState = &fixed.multisample;
    info.pDepthStencilState = &fixed.depth;
    info.pColorBlendState = &fixed.blend;
    info.pDynamicState = &fixed.dynamic;
    info.layout = description.layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check(context.fn.vkCreateGraphicsPipelines(context.device(), context.handles.pipeline_cache, 1, &info, nullptr,
                                               &pipeline),
          description.name);
    gpu::set_name(context, VK_OBJECT_TYPE_PIPELINE, pipeline, description.name);
    return {context.device(), pipeline, context.fn.vkDestroyPipeline};
}

} // namespace voile::engine
