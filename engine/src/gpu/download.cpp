// Copies device buffers to the host.
#include "voile/engine/gpu/download.hpp"

#include "voile/engine/gpu/frames.hpp"

#include "voile/gpu/recorder.hpp"

namespace voile::engine
{

std::vector<std::byte> download(const Device& device, std::span<const BufferRange> ranges)
{
    VkDeviceSize bytes = 0;
    for (const BufferRange& range : ranges)
        bytes += range.bytes;
    if (bytes == 0)
        return {};
    const gpu::Context& context = device.context();
    const gpu::Buffer host =
        take(gpu::create_buffer(context, "download", bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::readback));
    device.wait_idle();
    FrameRing ring(device, 1);
    const FrameRing::Frame frame = ring.begin();
    gpu::Recorder recorder(context, frame.cmd);
    recorder.barrier(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR, VK_ACCESS_2_MEMORY_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_READ_BIT_KHR);
    VkDeviceSize filled = 0;
    for (const BufferRange& range : ranges)
    {
        const VkBufferCopy region{range.offset, filled, range.bytes};
        if (range.bytes > 0)
            context.fn.vkCmdCopyBuffer(frame.cmd, range.buffer, host.handle(), 1, &region);
        filled += range.bytes;
    }
    recorder.barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                     VK_PIPELINE_STAGE_2_HOST_BIT_KHR, VK_ACCESS_2_HOST_READ_BIT_KHR);
    ring.submit(frame);
    ring.wait_all();
    host.invalidate();
    return {host.mapped().begin(), host.mapped().begin() + static_cast<std::ptrdiff_t>(bytes)};
}

} // namespace voile::engine
