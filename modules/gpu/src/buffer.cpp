// Buffer: allocation through the context's allocator.
#include "voile/gpu/buffer.hpp"

#include <algorithm>
#include <utility>

namespace voile::gpu
{

namespace
{

std::string size_text(VkDeviceSize bytes)
{
    if (bytes < 1u << 20)
        return std::to_string(bytes) + " bytes";
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

// A size that llvmpipe compiles no other kernel for. It compiles one for each combination of whether a texel buffer's
// size is a power of two, and whether its second byte is 0 (lp_sampler_static_texture_state of Mesa 22.3).
VkDeviceSize alike(VkDeviceSize bytes)
{
    return (bytes + 511) / 512 * 512 + 256;
}

} // namespace

Buffer::Buffer(std::shared_ptr<BufferAllocator> allocator, const BufferMemory& memory, VkDeviceSize size)
    : allocator_(std::move(allocator)), memory_(memory), size_(size)
{
}

Buffer::~Buffer()
{
    if (allocator_)
        allocator_->destroy_buffer(memory_);
}

Buffer::Buffer(Buffer&& other) noexcept
{
    *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept
{
    std::swap(allocator_, other.allocator_);
    std::swap(memory_, other.memory_);
    std::swap(size_, other.size_);
    return *this;
}

std::span<std::byte> Buffer::mapped() const
{
    if (memory_.mapped == nullptr)
        return {};
    return {static_cast<std::byte*>(memory_.mapped), static_cast<size_t>(size_)};
}

void Buffer::invalidate() const
{
    allocator_->invalidate(memory_);
}

void Buffer::flush() const
{
    allocator_->flush(memory_);
}

Result<Buffer> create_buffer(const Context& context, const char* name, VkDeviceSize bytes, VkBufferUsageFlags usage,
                             Memory memory)
{
    constexpr VkDeviceSize k_smallest = 16; // a descriptor needs a buffer
    const VkDeviceSize size = std::max(bytes, k_smallest);
    const bool is_bound = (usage & (VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)) != 0;
    if (is_bound && size > context.max_buffer_bytes)
        return Error{std::string("buffer \"") + name + "\" needs " + size_text(size) + ", the device binds at most " +
                     size_text(context.max_buffer_bytes)};

    BufferRequest request{size, usage, memory, name};
    if (context.texel_reads && (usage & VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) != 0)
    {
        request.bytes = std::max(size, std::min(alike(size), context.max_buffer_bytes));
        request.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    }
    const auto created = context.buffers->create_buffer(request);
    if (!created)
        return Error{std::string("buffer \"") + name + "\" of " + size_text(size) +
                     " cannot be made: " + created.error().message};
    set_name(context, VK_OBJECT_TYPE_BUFFER, created->buffer, name);
    return Buffer(context.buffers, *created, size);
}

VkDeviceAddress device_address(const Context& context, VkBuffer buffer)
{
    if (buffer == VK_NULL_HANDLE)
        return 0;
    VkBufferDeviceAddressInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    info.buffer = buffer;
    return context.fn.vkGetBufferDeviceAddress(context.device(), &info);
}

} // namespace voile::gpu
