// Buffer: allocation through the host's VulkanMemoryAllocator.
#include "voile/gpu/buffer.hpp"

#include <vk_mem_alloc.h>

#include <algorithm>
#include <utility>

namespace voile::gpu
{

namespace
{

VmaAllocationCreateFlags allocation_flags(Memory memory)
{
    switch (memory)
    {
    case Memory::device:
        return 0;
    case Memory::upload:
        return VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT | VMA_ALLOCATION_CREATE_MAPPED_BIT;
    case Memory::readback:
        return VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT | VMA_ALLOCATION_CREATE_MAPPED_BIT;
    }
    return 0;
}

std::string size_text(VkDeviceSize bytes)
{
    if (bytes < 1u << 20)
        return std::to_string(bytes) + " bytes";
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

} // namespace

Buffer::Buffer(const Context& context, VkBuffer buffer, VmaAllocation allocation, VkDeviceSize size, void* mapped)
    : allocator_(context.allocator()), buffer_(buffer), allocation_(allocation), size_(size), mapped_(mapped)
{
}

Buffer::~Buffer()
{
    if (buffer_ != VK_NULL_HANDLE)
        vmaDestroyBuffer(allocator_, buffer_, allocation_);
}

Buffer::Buffer(Buffer&& other) noexcept
{
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept
{
    std::swap(allocator_, other.allocator_);
    std::swap(buffer_, other.buffer_);
    std::swap(allocation_, other.allocation_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

std::span<std::byte> Buffer::mapped() const
{
    if (mapped_ == nullptr)
        return {};
    return {static_cast<std::byte*>(mapped_), static_cast<size_t>(size_)};
}

void Buffer::invalidate() const
{
    vmaInvalidateAllocation(allocator_, allocation_, 0, VK_WHOLE_SIZE);
}

void Buffer::flush() const
{
    vmaFlushAllocation(allocator_, allocation_, 0, VK_WHOLE_SIZE);
}

Result<Buffer> create_buffer(const Context& context, const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                             Memory memory)
{
    constexpr VkDeviceSize k_smallest = 16; // a descriptor needs a buffer
    const VkDeviceSize size = std::max(bytes, k_smallest);
    if (size > context.max_buffer_bytes)
        return Error{std::string("buffer \"") + name + "\" needs " + size_text(size) + ", the device binds at most " +
                     size_text(context.max_buffer_bytes)};

    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = usage;
    VmaAllocationCreateInfo allocation_info{};
    allocation_info.flags = allocation_flags(memory);
    allocation_info.usage = memory == Memory::device ? VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE : VMA_MEMORY_USAGE_AUTO;

    VkBuffer buffer = VK_NULL_HANDLE;
    VmaAllocation allocation = VK_NULL_HANDLE;
    VmaAllocationInfo result{};
    const VkResult status =
        vmaCreateBuffer(context.allocator(), &info, &allocation_info, &buffer, &allocation, &result);
    if (status != VK_SUCCESS)
        return Error{std::string("buffer \"") + name + "\" of " + size_text(size) +
                     " cannot be made: " + to_string(status)};
    set_name(context, VK_OBJECT_TYPE_BUFFER, buffer, name);
    return Buffer(context, buffer, allocation, size, result.pMappedData);
}

} // namespace voile::gpu
