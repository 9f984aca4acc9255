// UploadBatch: staging buffers and their copies.
#include "voile/engine/gpu/upload.hpp"

#include "voile/engine/gpu/device.hpp"

#include <algorithm>

namespace voile::engine
{

gpu::Buffer UploadBatch::buffer(const char* name, std::span<const std::byte> bytes, VkBufferUsageFlags usage)
{
    gpu::Buffer result = take(
        gpu::create_buffer(context_, name, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Memory::device));
    if (bytes.empty())
        return result;
    gpu::Buffer staging =
        take(gpu::create_buffer(context_, "staging", bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Memory::upload));
    std::copy(bytes.begin(), bytes.end(), staging.mapped().begin());
    staging.flush();
    copies_.push_back({result.handle(), bytes.size(), std::move(staging)});
    return result;
}

void UploadBatch::record(VkCommandBuffer cmd)
{
    if (copies_.empty())
        return;
    for (const Copy& copy : copies_)
    {
        const VkBufferCopy region{0, 0, copy.bytes};
        context_.fn.vkCmdCopyBuffer(cmd, copy.staging.handle(), copy.destination, 1, &region);
    }
    gpu::Recorder(context_, cmd)
        .barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                 VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT_KHR | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR,
                 VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT_KHR | VK_ACCESS_2_INDEX_READ_BIT_KHR |
                     VK_ACCESS_2_SHADER_READ_BIT_KHR);
}

} // namespace voile::engine
