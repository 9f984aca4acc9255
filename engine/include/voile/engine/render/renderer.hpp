// Renderer: draws a scene into an image. A sun shadow map, then one shaded pass with 4x MSAA. Tone mapping is part of
// shading.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/image.hpp"
#include "voile/engine/scene/scene.hpp"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voile::engine
{

struct RendererOptions
{
    VkExtent2D extent{1280, 720};
    uint32_t slots = 2; // frames in flight
    uint32_t shadow_resolution = 2048;
};

// What is shown besides the shaded scene.
struct ViewModes
{
    float full_strain = 0; // colors fabric by its largest stretch, l / L - 1: this is the hottest color. 0: does not
    bool wires = false;    // the edges of triangles; needs Device::draws_wires
};

// A shader of the renderer in another version.
struct ShaderCode
{
    std::string name; // of shader_names()
    std::vector<uint32_t> spirv;
};

// The shaders that may be replaced, by their files in shaders/render: "surface.frag" ...
std::span<const std::string_view> shader_names();

class Renderer
{
public:
    Renderer(const Device& device, const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Records the shadow pass and the shaded pass of `scene`. Vertex data must already be visible to vertex input.
    // Ends with color() in TRANSFER_SRC_OPTIMAL, its writes available to a following copy or blit.
    void record(VkCommandBuffer cmd, const Scene& scene, const FrameInfo& frame);

    // Other versions of shaders, from the next frame on, with the same inputs, outputs, bindings and push constants.
    // Waits for the device. Error if the renderer has no such shader or the driver refuses one: all stay as they were.
    Result<void> replace_shaders(const std::vector<ShaderCode>& replacements);

    // May be changed between frames.
    ViewModes modes;

    // The finished picture: VK_FORMAT_R8G8B8A8_SRGB, one sample, of the renderer's extent.
    [[nodiscard]] const Image& color() const;
    [[nodiscard]] VkExtent2D extent() const;

    // Recreates the targets in another size. The device must be idle.
    void resize(VkExtent2D extent);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace voile::engine
