// ScenePipelines: the pipelines of the two maps and of the scene.
#pragma once

#include "gpu/owned.hpp"
#include "render/graphics_pipeline.hpp"
#include "render/shader_set.hpp"

namespace voile::engine
{

constexpr VkFormat k_color_format = VK_FORMAT_R8G8B8A8_SRGB;
constexpr VkFormat k_depth_format = VK_FORMAT_D32_SFLOAT;
constexpr VkSampleCountFlagBits k_samples = VK_SAMPLE_COUNT_4_BIT; // every device has 4 for these formats

class ScenePipelines
{
public:
    // StartupError when the driver refuses one.
    ScenePipelines(const gpu::Context& context, VkPipelineLayout layout, ShaderSet shaders);

    [[nodiscard]] const ShaderSet& shaders() const { return shaders_; }
    [[nodiscard]] VkPipeline shadow() const { return shadow_.get(); }
    [[nodiscard]] VkPipeline height() const { return height_.get(); }
    [[nodiscard]] VkPipeline surfaces() const { return surfaces_.get(); }
    [[nodiscard]] VkPipeline sky() const { return sky_.get(); }
    // Created on first use, because a normal run draws none. StartupError when the driver refuses.
    VkPipeline wires(); // slightly closer to the camera than the surface
    VkPipeline lines();
    VkPipeline dots(bool flag_words);

private:
    [[nodiscard]] GraphicsPipelineDescription scene_description(const char* name) const;
    [[nodiscard]] Owned<VkPipeline> create_map(const char* name, const char* vertex) const;
    [[nodiscard]] Owned<VkPipeline> create_marks(const char* name, const char* vertex,
                                                 const VertexStream& second) const;

    const gpu::Context& context_;
    VkPipelineLayout layout_;
    ShaderSet shaders_;
    Owned<VkPipeline> shadow_;
    Owned<VkPipeline> height_;
    Owned<VkPipeline> surfaces_;
    Owned<VkPipeline> sky_;
    Owned<VkPipeline> wires_;
    Owned<VkPipeline> lines_;
    Owned<VkPipeline> dots_;
    Owned<VkPipeline> flagged_dots_;
};

} // namespace voile::engine
