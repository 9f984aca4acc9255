// Copies device buffers to the host, at the end of a run and for tests. The calls wait for the device.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

namespace voile::engine
{

// Returns `bytes` bytes from `offset`. The buffer must have TRANSFER_SRC usage and its writers must be submitted. Waits
// for all work of the device. StartupError if memory runs out or the device is lost.
std::vector<std::byte> download(const Device& device, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes);

template <typename T>
std::vector<T> download_values(const Device& device, VkBuffer buffer, VkDeviceSize offset, size_t count)
{
    const std::vector<std::byte> bytes = download(device, buffer, offset, count * sizeof(T));
    std::vector<T> values(count);
    if (count > 0)
        std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

} // namespace voile::engine
