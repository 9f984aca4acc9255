// Readback: image to buffer copies.
#include "voile/engine/render/readback.hpp"

#include "voile/gpu/recorder.hpp"

#include <algorithm>

namespace voile::engine
{

Readback::Readback(const Device& device, VkExtent2D extent, uint32_t slots) : device_(device), extent_(extent)
{
    const VkDeviceSize bytes = VkDeviceSize{4} * extent.width * extent.height;
    for (uint32_t i = 0; i < slots; ++i)
        buffers_.push_back(take(gpu::create_buffer(device.context(), "picture readback", bytes,
                                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback)));
}

void Readback::record(VkCommandBuffer cmd, const Image& image, uint32_t slot) const
{
    const gpu::Context& context = device_.context();
    const gpu::LabelScope scope(context, cmd, "picture readback");
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {extent_.width, extent_.height, 1};
    context.fn.vkCmdCopyImageToBuffer(cmd, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                      buffers_[slot].handle(), 1, &region);
    gpu::Recorder(context, cmd)
        .barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR, VK_PIPELINE_STAGE_2_HOST_BIT_KHR,
                 VK_ACCESS_2_HOST_READ_BIT_KHR);
}

Picture Readback::picture(uint32_t slot) const
{
    Picture picture{extent_.width, extent_.height, {}};
    buffers_[slot].invalidate();
    picture.rgba.resize(size_t{4} * extent_.width * extent_.height);
    const auto* pixels = reinterpret_cast<const uint8_t*>(buffers_[slot].mapped().data());
    std::copy_n(pixels, picture.rgba.size(), picture.rgba.begin());
    return picture;
}

} // namespace voile::engine
