// Allocator: VulkanMemoryAllocator behind the interface that a host's allocator has as well.
#include "voile/gpu/allocator.hpp"

#include "voile/gpu/context.hpp"

#include "vma.hpp"

namespace voile::gpu
{

namespace
{

// Solvers without an allocator of the host's have one each, so blocks are small beside VulkanMemoryAllocator's 256 MiB.
constexpr VkDeviceSize k_block_bytes = VkDeviceSize{64} << 20;

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

} // namespace

struct Allocator::Implementation
{
    VmaAllocator vma = VK_NULL_HANDLE;
    bool device_addresses = false;
};

Allocator::Allocator(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Allocator::~Allocator()
{
    vmaDestroyAllocator(implementation_->vma);
}

Result<std::unique_ptr<Allocator>> Allocator::create(const Handles& handles, bool device_addresses)
{
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = handles.get_instance_proc_addr;
    functions.vkGetDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
        handles.get_instance_proc_addr(handles.instance, "vkGetDeviceProcAddr"));
    VmaAllocatorCreateInfo info{};
    info.flags = device_addresses ? VMA_ALLOCATOR_CREATE_BUFFER_DEVICE_ADDRESS_BIT : 0;
    info.instance = handles.instance;
    info.physicalDevice = handles.physical_device;
    info.device = handles.device;
    info.vulkanApiVersion = VK_API_VERSION_1_2;
    info.preferredLargeHeapBlockSize = k_block_bytes;
    info.pVulkanFunctions = &functions;
    auto implementation = std::make_unique<Implementation>();
    implementation->device_addresses = device_addresses;
    if (const VkResult status = vmaCreateAllocator(&info, &implementation->vma); status != VK_SUCCESS)
        return Error{"memory allocator cannot be made: " + to_string(status)};
    return std::unique_ptr<Allocator>(new Allocator(std::move(implementation)));
}

Result<BufferMemory> Allocator::create_buffer(const BufferRequest& request) noexcept
{
    if ((request.usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0 && !implementation_->device_addresses)
        return Error{"its allocator was made without device addresses"};
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = request.bytes;
    info.usage = request.usage;
    VmaAllocationCreateInfo allocation_info{};
    allocation_info.flags = allocation_flags(request.memory);
    allocation_info.usage =
        request.memory == Memory::device ? VMA_MEMORY_USAGE_AUTO_PREFER_DEVICE : VMA_MEMORY_USAGE_AUTO;
    BufferMemory memory;
    VmaAllocation allocation = VK_NULL_HANDLE;
    VmaAllocationInfo result{};
    const VkResult status =
        vmaCreateBuffer(implementation_->vma, &info, &allocation_info, &memory.buffer, &allocation, &result);
    if (status != VK_SUCCESS)
        return Error{to_string(status)};
    memory.mapped = result.pMappedData;
    memory.allocation = allocation;
    return memory;
}

void Allocator::destroy_buffer(const BufferMemory& memory) noexcept
{
    vmaDestroyBuffer(implementation_->vma, memory.buffer, static_cast<VmaAllocation>(memory.allocation));
}

void Allocator::flush(const BufferMemory& memory) noexcept
{
    vmaFlushAllocation(implementation_->vma, static_cast<VmaAllocation>(memory.allocation), 0, VK_WHOLE_SIZE);
}

void Allocator::invalidate(const BufferMemory& memory) noexcept
{
    vmaInvalidateAllocation(implementation_->vma, static_cast<VmaAllocation>(memory.allocation), 0, VK_WHOLE_SIZE);
}

VkResult Allocator::create_image(const VkImageCreateInfo& info, ImageMemory& image)
{
    VmaAllocationCreateInfo allocation_info{};
    allocation_info.usage = VMA_MEMORY_USAGE_AUTO;
    VmaAllocation allocation = VK_NULL_HANDLE;
    const VkResult status =
        vmaCreateImage(implementation_->vma, &info, &allocation_info, &image.image, &allocation, nullptr);
    image.allocation = allocation;
    return status;
}

void Allocator::destroy_image(const ImageMemory& image)
{
    vmaDestroyImage(implementation_->vma, image.image, static_cast<VmaAllocation>(image.allocation));
}

} // namespace voile::gpu
