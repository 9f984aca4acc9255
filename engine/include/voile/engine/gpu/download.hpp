// Copies of device buffers on the host, for the end of a run and for tests: they wait for the device.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <cstddef>
#include <cstring>
#include <vector>

namespace voile::engine
{

// `bytes` bytes from `offset` on, of a buffer with TRANSFER_SRC usage whose writers have been submitted. Waits for all
// work of the device. StartupError when memory runs out or the device is lost.
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
