// Buffer: a VkBuffer and its memory, freed together.
#pragma once

#include "voile/gpu/context.hpp"

#include <cstring>
#include <span>

namespace voile::gpu
{

class VOILE_GPU_API Buffer
{
public:
    Buffer() = default;
    Buffer(std::shared_ptr<BufferAllocator> allocator, const BufferMemory& memory, VkDeviceSize size);
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    [[nodiscard]] VkBuffer handle() const { return memory_.buffer; }
    [[nodiscard]] VkDeviceSize size() const { return size_; } // bytes
    explicit operator bool() const { return handle() != VK_NULL_HANDLE; }

    // The mapped bytes; empty for Memory::device. Memory of the other kinds is mapped for its whole life.
    [[nodiscard]] std::span<std::byte> mapped() const;

    // Makes the device's writes visible to the host (needed where memory is not coherent).
    void invalidate() const;
    // Makes the host's writes visible to the device.
    void flush() const;

private:
    std::shared_ptr<BufferAllocator> allocator_;
    BufferMemory memory_;
    VkDeviceSize size_ = 0;
};

// A size of 0 gives a buffer of 16 bytes, so that it can be bound. Where the context has texel_reads, the VkBuffer is
// up to 767 bytes longer. Errors: larger than the device's limits, out of memory; the message names the buffer and its
// size.
VOILE_GPU_API Result<Buffer> create_buffer(const Context& context, const char* name, VkDeviceSize bytes,
                                           VkBufferUsageFlags usage, Memory memory);

// Of a buffer with VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT; 0 for a null one.
VOILE_GPU_API VkDeviceAddress device_address(const Context& context, VkBuffer buffer);

} // namespace voile::gpu
