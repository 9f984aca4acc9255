// Readback: copies finished pictures into host memory, one buffer per frame slot, without a stall.
#pragma once

#include "voile/engine/assets/image_file.hpp"
#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/image.hpp"

#include "voile/gpu/buffer.hpp"

#include <vector>

namespace voile::engine
{

class Readback
{
public:
    // For RGBA8 images of `extent`. StartupError when the buffers cannot be made.
    Readback(const Device& device, VkExtent2D extent, uint32_t slots);

    // `image` must be in TRANSFER_SRC_OPTIMAL with its writes available to copies, as Renderer::record leaves it.
    void record(VkCommandBuffer cmd, const Image& image, uint32_t slot) const;

    // The picture of `slot`. Its submission must have completed.
    [[nodiscard]] Picture picture(uint32_t slot) const;

private:
    const Device& device_;
    VkExtent2D extent_;
    std::vector<gpu::Buffer> buffers_;
};

} // namespace voile::engine
