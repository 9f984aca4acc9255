// Renderer: targets, pipelines, and the recording of the two passes.
#include "voile/engine/render/renderer.hpp"

#include "render/frame_bindings.hpp"
#include "render/pass_view.hpp"
#include "render/scene_pipelines.hpp"

#include "voile/gpu/recorder.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace voile::engine
{

namespace
{

constexpr VkPipelineStageFlags2KHR k_depth_stages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT_KHR | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT_KHR;
constexpr VkAccessFlags2KHR k_depth_access =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT_KHR | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT_KHR;
constexpr VkPipelineStageFlags2KHR k_color_stage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT_KHR;
constexpr VkAccessFlags2KHR k_color_access =
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT_KHR | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT_KHR;

struct Targets
{
    Image color;   // resolved
    Image samples; // multisampled target
    Image depth;

    Targets() = default;
    Targets(const Device& device, VkExtent2D extent)
        : color(device, {.name = "color",
                         .format = k_color_format,
                         .extent = extent,
                         .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT}),
          samples(device, {.name = "color samples",
                           .format = k_color_format,
                           .extent = extent,
                           .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT,
                           .samples = k_samples}),
          depth(device, {.name = "depth",
                         .format = k_depth_format,
                         .extent = extent,
                         .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT,
                         .aspect = VK_IMAGE_ASPECT_DEPTH_BIT,
                         .samples = k_samples})
    {
    }
};

constexpr uint32_t k_height_resolution = 512;

Image create_depth_map(const Device& device, const char* name, uint32_t resolution)
{
    return {device,
            {.name = name,
             .format = k_depth_format,
             .extent = {resolution, resolution},
             .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
             .aspect = VK_IMAGE_ASPECT_DEPTH_BIT}};
}

// With depth 1 at the near plane and 0 at the far one: floats are then equally precise at all distances (Reed 2015,
// "Depth precision visualized").
glm::mat4 camera_matrix(const Camera& camera, VkExtent2D extent, float focus_radius)
{
    const float aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    const float far_plane = glm::distance(camera.position, camera.target) + 100 * focus_radius;
    glm::mat4 projection = glm::perspectiveRH_ZO(glm::radians(camera.fov), aspect, far_plane, far_plane * 1e-4f);
    projection[1][1] *= -1; // Vulkan's y points down
    const glm::vec3 forward = camera.target - camera.position;
    const bool vertical = std::abs(forward.x) + std::abs(forward.z) < 1e-4f * glm::length(forward);
    return projection *
           glm::lookAtRH(camera.position, camera.target, vertical ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0));
}

// An orthographic view of the sphere around the scene's focus. It is deep enough for casters outside the sphere.
glm::mat4 shadow_matrix(const Scene& scene, const glm::vec3& to_sun)
{
    const float r = scene.focus_radius;
    const glm::vec3 up = std::abs(to_sun.y) > 0.99f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    return glm::orthoRH_ZO(-r, r, -r, r, 0.f, 6 * r) * glm::lookAtRH(scene.focus + 3 * r * to_sun, scene.focus, up);
}

// The same sphere from above.
glm::mat4 height_matrix(const Scene& scene)
{
    const float r = scene.focus_radius;
    return glm::orthoRH_ZO(-r, r, -r, r, 0.f, 6 * r) *
           glm::lookAtRH(scene.focus + glm::vec3(0, 3 * r, 0), scene.focus, glm::vec3(0, 0, -1));
}

void set_viewport(const gpu::Context& context, VkCommandBuffer cmd, VkExtent2D extent)
{
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    context.fn.vkCmdSetViewport(cmd, 0, 1, &viewport);
    context.fn.vkCmdSetScissor(cmd, 0, 1, &scissor);
}

VkRenderingAttachmentInfoKHR depth_attachment(VkImageView view, VkAttachmentStoreOp store, float far_depth)
{
    VkRenderingAttachmentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO_KHR;
    info.imageView = view;
    info.imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = store;
    info.clearValue.depthStencil = {far_depth, 0};
    return info;
}

} // namespace

struct Renderer::State
{
    const Device& device;
    const gpu::Context& context;
    RendererOptions options;
    Targets targets;
    Image shadow_map;
    Image height_map;
    FrameBindings bindings;
    std::unique_ptr<ScenePipelines> pipelines;

    State(const Device& on, const RendererOptions& wanted)
        : device(on), context(on.context()), options(wanted), targets(on, wanted.extent),
          shadow_map(create_depth_map(on, "shadow map", wanted.shadow_resolution)),
          height_map(create_depth_map(on, "height map", k_height_resolution)),
          bindings(device, wanted.slots, shadow_map.view(), height_map.view()),
          pipelines(std::make_unique<ScenePipelines>(context, bindings.layout(), ShaderSet()))
    {
    }

    [[nodiscard]] shared::FrameUniforms uniforms(const Scene& scene, const ViewModes& wanted) const;
    struct DepthMap
    {
        const Image& image;
        const glm::mat4& clip_from_world;
        VkPipeline pipeline;
    };
    void record_map(VkCommandBuffer cmd, const Scene& scene, const DepthMap& map) const;
    void record_scene(VkCommandBuffer cmd, const Scene& scene, const shared::FrameUniforms& uniforms,
                      const ViewModes& wanted);
    void transition_targets(VkCommandBuffer cmd) const;
};

shared::FrameUniforms Renderer::State::uniforms(const Scene& scene, const ViewModes& wanted) const
{
    shared::FrameUniforms result{};
    result.clip_from_world = camera_matrix(scene.camera, options.extent, scene.focus_radius);
    result.world_from_clip = glm::inverse(result.clip_from_world);
    result.camera_position = scene.camera.position;
    result.to_sun = -glm::normalize(scene.sun.direction);
    result.shadow_from_world = shadow_matrix(scene, result.to_sun);
    result.height_from_world = height_matrix(scene);
    const auto resolution = static_cast<float>(options.shadow_resolution);
    result.shadow_texel = 2 * scene.focus_radius / resolution;
    result.shadow_step = 1 / resolution;
    result.sun_irradiance = scene.sun.irradiance;
    result.focus = scene.focus;
    result.focus_radius = scene.focus_radius;
    result.full_strain = wanted.full_strain;
    return result;
}

void Renderer::State::record_map(VkCommandBuffer cmd, const Scene& scene, const DepthMap& map) const
{
    record_transition(context, cmd, map.image.handle(), map.image.aspect(),
                      {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                       VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT_KHR, 0, k_depth_stages, k_depth_access});
    const VkRenderingAttachmentInfoKHR depth = depth_attachment(map.image.view(), VK_ATTACHMENT_STORE_OP_STORE, 1);
    VkRenderingInfoKHR rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO_KHR;
    rendering.renderArea.extent = map.image.extent();
    rendering.layerCount = 1;
    rendering.pDepthAttachment = &depth;
    context.fn.vkCmdBeginRenderingKHR(cmd, &rendering);
    set_viewport(context, cmd, map.image.extent());
    PassView view(View::Kind::shadow, map.clip_from_world, context,
                  {.layout = bindings.layout(), .surfaces = map.pipeline});
    scene.record_draw(cmd, view);
    context.fn.vkCmdEndRenderingKHR(cmd);
    record_transition(context, cmd, map.image.handle(), map.image.aspect(),
                      {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                       VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, k_depth_stages, k_depth_access,
                       VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT_KHR, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT_KHR});
}

// Waits for the previous frame's writes and for copies of the picture. The old contents are discarded.
void Renderer::State::transition_targets(VkCommandBuffer cmd) const
{
    for (const Image* image : {&targets.color, &targets.samples})
        record_transition(context, cmd, image->handle(), image->aspect(),
                          {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                           k_color_stage | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                           VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT_KHR, k_color_stage, k_color_access});
    record_transition(context, cmd, targets.depth.handle(), targets.depth.aspect(),
                      {VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, k_depth_stages,
                       VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT_KHR, k_depth_stages, k_depth_access});
}

void Renderer::State::record_scene(VkCommandBuffer cmd, const Scene& scene, const shared::FrameUniforms& uniforms,
                                   const ViewModes& wanted)
{
    transition_targets(cmd);
    VkRenderingAttachmentInfoKHR color{};
    color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO_KHR;
    color.imageView = targets.samples.view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = targets.color.view();
    color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE; // the sky covers the rest
    color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    const VkRenderingAttachmentInfoKHR depth =
        depth_attachment(targets.depth.view(), VK_ATTACHMENT_STORE_OP_DONT_CARE, 0);
    VkRenderingInfoKHR rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_RENDERING_INFO_KHR;
    rendering.renderArea.extent = options.extent;
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    context.fn.vkCmdBeginRenderingKHR(cmd, &rendering);
    set_viewport(context, cmd, options.extent);
    PassView view(View::Kind::camera, uniforms.clip_from_world, context,
                  {.layout = bindings.layout(),
                   .surfaces = pipelines->surfaces(),
                   .wires = wanted.wires && device.draws_wires() ? pipelines->wires() : VK_NULL_HANDLE,
                   .marks = pipelines.get(),
                   .extent = options.extent});
    scene.record_draw(cmd, view);
    {
        const gpu::LabelScope scope(context, cmd, "sky");
        context.fn.vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines->sky());
        context.fn.vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    context.fn.vkCmdEndRenderingKHR(cmd);
    record_transition(context, cmd, targets.color.handle(), targets.color.aspect(),
                      {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, k_color_stage,
                       VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT_KHR,
                       VK_ACCESS_2_TRANSFER_READ_BIT_KHR});
}

Renderer::Renderer(const Device& device, const RendererOptions& options)
    : state_(std::make_unique<State>(device, options))
{
}

Renderer::~Renderer() = default;

void Renderer::record(VkCommandBuffer cmd, const Scene& scene, const FrameInfo& frame)
{
    const shared::FrameUniforms uniforms = state_->uniforms(scene, modes);
    state_->bindings.bind(cmd, frame.slot, uniforms);
    {
        const gpu::LabelScope scope(state_->context, cmd, "shadow map", frame.timestamps);
        state_->record_map(cmd, scene, {state_->shadow_map, uniforms.shadow_from_world, state_->pipelines->shadow()});
    }
    {
        const gpu::LabelScope scope(state_->context, cmd, "height map", frame.timestamps);
        state_->record_map(cmd, scene, {state_->height_map, uniforms.height_from_world, state_->pipelines->height()});
    }
    const gpu::LabelScope scope(state_->context, cmd, "scene", frame.timestamps);
    state_->record_scene(cmd, scene, uniforms, modes);
}

Result<void> Renderer::replace_shaders(const std::vector<ShaderCode>& replacements)
{
    auto shaders = ShaderSet::with(state_->pipelines->shaders(), replacements);
    if (!shaders)
        return shaders.error();
    try
    {
        auto next =
            std::make_unique<ScenePipelines>(state_->context, state_->bindings.layout(), std::move(shaders.value()));
        state_->device.wait_idle();
        state_->pipelines = std::move(next);
        return {};
    }
    catch (const StartupError& error)
    {
        return Error{error.what()};
    }
}

const Image& Renderer::color() const
{
    return state_->targets.color;
}

VkExtent2D Renderer::extent() const
{
    return state_->options.extent;
}

void Renderer::resize(VkExtent2D extent)
{
    state_->targets = Targets(state_->device, extent);
    state_->options.extent = extent;
}

} // namespace voile::engine
