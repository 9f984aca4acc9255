// Buffer: a VkBuffer and its memory, freed together.
#pragma once

#include "voile/gpu/context.hpp"

#include <cstring>
#include <span>

namespace voile::gpu
{

enum class Memory
{
    device,   // fast on the device, not visible to the host
    upload,   // written by the host front to back, read by the device
    readback, // written by the device, read by the host (cached)
};

class Buffer
{
public:
    Buffer() = default;
    Buffer(const Context& context, VkBuffer buffer, VmaAllocation allocation, VkDeviceSize size, void* mapped);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    [[nodiscard]] VkBuffer handle() const { return buffer_; }
    [[nodiscard]] VkDeviceSize size() const { return size_; } // bytes
    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

    // The mapped bytes; empty for Memory::device. Memory of the other kinds is mapped for its whole life.
    [[nodiscard]] std::span<std::byte> mapped() const;

    // Makes the device's writes visible to the host (needed where memory is not coherent).
    void invalidate() const;
    // Makes the host's writes visible to the device.
    void flush() const;

private:
    VmaAllocator allocator_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VmaAllocation allocation_ = VK_NULL_HANDLE;
    VkDeviceSize size_ = 0;
    void* mapped_ = nullptr;
};

// A size of 0 gives a buffer of 16 bytes, so that it can be bound. Errors: larger than the device's limits,
// out of memory; the message names the buffer and its size.
Result<Buffer> create_buffer(const Context& context, const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                             Memory memory);

} // namespace voile::gpu
