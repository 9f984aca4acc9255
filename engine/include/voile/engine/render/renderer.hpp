// Renderer: draws a scene into an image. A sun shadow map, then one shaded pass with 4x MSAA. Tone mapping is part of
// shading.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/image.hpp"
#include "voile/engine/scene/scene.hpp"

#include <memory>

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
