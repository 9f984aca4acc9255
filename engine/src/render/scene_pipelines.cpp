// ScenePipelines.
#include "render/scene_pipelines.hpp"

#include <array>
#include <utility>

namespace voile::engine
{

namespace
{

constexpr std::array<VertexStream, 3> k_streams{
    {{VK_FORMAT_R32G32B32A32_SFLOAT, 16}, {VK_FORMAT_R32G32B32A32_SFLOAT, 16}, {VK_FORMAT_R32G32_SFLOAT, 8}}};
constexpr VertexStream k_vectors{VK_FORMAT_R32G32B32A32_SFLOAT, 16, VK_VERTEX_INPUT_RATE_INSTANCE};
constexpr VertexStream k_words{VK_FORMAT_R32_UINT, 4, VK_VERTEX_INPUT_RATE_INSTANCE};

} // namespace

ScenePipelines::ScenePipelines(const gpu::Context& context, VkPipelineLayout layout, ShaderSet shaders)
    : context_(context), layout_(layout), shaders_(std::move(shaders))
{
    shadow_ = create_map("shadow map", "shadow.vert");
    height_ = create_map("height map", "height.vert");
    GraphicsPipelineDescription surfaces = scene_description("surface");
    surfaces.vertex = shaders_["surface.vert"];
    surfaces.fragment = shaders_["surface.frag"];
    surfaces.streams = k_streams;
    surfaces_ = create_graphics_pipeline(context_, surfaces);
    GraphicsPipelineDescription sky = scene_description("sky");
    sky.vertex = shaders_["sky.vert"];
    sky.fragment = shaders_["sky.frag"];
    sky.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    sky.depth_write = false;
    sky_ = create_graphics_pipeline(context_, sky);
}

GraphicsPipelineDescription ScenePipelines::scene_description(const char* name) const
{
    return {.name = name,
            .vertex = {},
            .layout = layout_,
            .color_format = k_color_format,
            .depth_format = k_depth_format,
            .samples = k_samples,
            .depth_compare = VK_COMPARE_OP_GREATER}; // depth is 1 near and 0 far
}

Owned<VkPipeline> ScenePipelines::create_map(const char* name, const char* vertex) const
{
    return create_graphics_pipeline(context_, {.name = name,
                                               .vertex = shaders_[vertex],
                                               .streams = std::span(k_streams).first(1),
                                               .layout = layout_,
                                               .depth_format = k_depth_format,
                                               .depth_bias = 2});
}

VkPipeline ScenePipelines::wires()
{
    if (wires_.get() == VK_NULL_HANDLE)
    {
        GraphicsPipelineDescription wires = scene_description("wires");
        wires.vertex = shaders_["surface.vert"];
        wires.fragment = shaders_["wire.frag"];
        wires.streams = k_streams;
        wires.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
        wires.depth_write = false;
        wires.depth_bias = 2;
        wires.wires = true;
        wires_ = create_graphics_pipeline(context_, wires);
    }
    return wires_.get();
}

Owned<VkPipeline> ScenePipelines::create_marks(const char* name, const char* vertex, const VertexStream& second) const
{
    const std::array streams{k_vectors, second};
    GraphicsPipelineDescription marks = scene_description(name);
    marks.vertex = shaders_[vertex];
    marks.fragment = shaders_["mark.frag"];
    marks.streams = streams;
    return create_graphics_pipeline(context_, marks);
}

VkPipeline ScenePipelines::lines()
{
    if (lines_.get() == VK_NULL_HANDLE)
        lines_ = create_marks("lines", "line.vert", k_vectors);
    return lines_.get();
}

VkPipeline ScenePipelines::dots(bool flag_words)
{
    Owned<VkPipeline>& pipeline = flag_words ? flagged_dots_ : dots_;
    if (pipeline.get() == VK_NULL_HANDLE)
        pipeline = flag_words ? create_marks("flagged dots", "flagged_dot.vert", k_words)
                              : create_marks("dots", "dot.vert", k_vectors);
    return pipeline.get();
}

} // namespace voile::engine
