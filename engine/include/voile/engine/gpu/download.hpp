// Copies device buffers to the host, at the end of a run and for tests. The calls wait for the device.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace voile::engine
{

struct BufferRange
{
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0; // bytes
    VkDeviceSize bytes = 0;
};

// Returns the bytes of all ranges, one after another, in one submission. The buffers must have TRANSFER_SRC usage and
// their writers must be submitted. Waits for all work of the device. StartupError if memory runs out or the device is
// lost.
std::vector<std::byte> download(const Device& device, std::span<const BufferRange> ranges);

template <typename T>
std::vector<T> download_values(const Device& device, VkBuffer buffer, VkDeviceSize offset, size_t count)
{
    const BufferRange range{buffer, offset, count * sizeof(T)};
    const std::vector<std::byte> bytes = download(device, std::span(&range, 1));
    std::vector<T> values(count);
    if (count > 0)
        std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

} // namespace voile::engine
