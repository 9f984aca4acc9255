// Overlay: draws triangles in pixels over the finished picture, such as those of a user interface.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/image.hpp"

#include <glm/glm.hpp>

#include <memory>
#include <span>
#include <vector>

namespace voile::engine
{

struct OverlayVertex
{
    glm::vec2 position;   // pixels from the upper left corner
    glm::vec2 coordinate; // in the coverage image, 0..1
    uint32_t color;       // sRGB, red in the lowest byte, alpha in the highest
};

// Triangles within a rectangle.
struct OverlayPart
{
    VkRect2D scissor{};
    uint32_t first_index = 0;
    uint32_t index_count = 0;
    int32_t vertex_offset = 0; // added to its indices
};

struct OverlayTriangles
{
    std::vector<OverlayVertex> vertices;
    std::vector<uint16_t> indices;
    std::vector<OverlayPart> parts; // drawn in this order
};

// The alpha of every pixel of an overlay is multiplied by this image: glyphs, and a white area for everything else.
struct Coverage
{
    std::span<const std::byte> pixels; // one byte each
    VkExtent2D extent{};
};

class Overlay
{
public:
    // For targets of `format`. `slots`: frames in flight. StartupError if something cannot be made.
    Overlay(const Device& device, uint32_t slots, VkFormat format, const Coverage& coverage);
    ~Overlay();
    Overlay(const Overlay&) = delete;
    Overlay& operator=(const Overlay&) = delete;

    // Draws over `target`, which is in TRANSFER_SRC_OPTIMAL before and after, as Renderer::record leaves it. The slot's
    // previous use must have completed.
    void record(VkCommandBuffer cmd, const Image& target, uint32_t slot, const OverlayTriangles& triangles);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace voile::engine
