// A host with a VulkanMemoryAllocator of its own, which serves the solver's buffers.
#include <vulkan/vulkan_core.h>

#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_IMPLEMENTATION
#include <vk_mem_alloc.h>

#include "falling_sheet.hpp"

namespace
{

class Adapter final : public voile::BufferAllocator
{
public:
    explicit Adapter(VmaAllocator vma) : vma_(vma) {}

    voile::Result<voile::BufferMemory> create_buffer(const voile::BufferRequest& request) noexcept override
    {
        VkBufferCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
        info.size = request.bytes;
        info.usage = request.usage;
        VmaAllocationCreateInfo wanted{};
        wanted.usage = VMA_MEMORY_USAGE_AUTO;
        if (request.memory == voile::Memory::upload)
            wanted.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_SEQUENTIAL_WRITE_BIT;
        if (request.memory == voile::Memory::readback)
            wanted.flags = VMA_ALLOCATION_CREATE_MAPPED_BIT | VMA_ALLOCATION_CREATE_HOST_ACCESS_RANDOM_BIT;
        voile::BufferMemory memory;
        VmaAllocation allocation = VK_NULL_HANDLE;
        VmaAllocationInfo made{};
        if (vmaCreateBuffer(vma_, &info, &wanted, &memory.buffer, &allocation, &made) != VK_SUCCESS)
            return voile::Error{"out of memory"};
        memory.mapped = made.pMappedData;
        memory.allocation = allocation;
        ++made_;
        ++alive_;
        return memory;
    }
    void destroy_buffer(const voile::BufferMemory& memory) noexcept override
    {
        vmaDestroyBuffer(vma_, memory.buffer, static_cast<VmaAllocation>(memory.allocation));
        --alive_;
    }
    void flush(const voile::BufferMemory& memory) noexcept override
    {
        vmaFlushAllocation(vma_, static_cast<VmaAllocation>(memory.allocation), 0, VK_WHOLE_SIZE);
    }
    void invalidate(const voile::BufferMemory& memory) noexcept override
    {
        vmaInvalidateAllocation(vma_, static_cast<VmaAllocation>(memory.allocation), 0, VK_WHOLE_SIZE);
    }

    [[nodiscard]] int made() const { return made_; }
    [[nodiscard]] int alive() const { return alive_; }

private:
    VmaAllocator vma_;
    int made_ = 0;
    int alive_ = 0;
};

} // namespace

int main()
{
    foreign::Engine engine;
    VmaVulkanFunctions functions{};
    functions.vkGetInstanceProcAddr = engine.get_instance_proc_addr();
    functions.vkGetDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(engine.find("vkGetDeviceProcAddr"));
    VmaAllocatorCreateInfo info{};
    info.instance = engine.instance();
    info.physicalDevice = engine.physical_device();
    info.device = engine.device();
    info.vulkanApiVersion = VK_API_VERSION_1_3;
    info.pVulkanFunctions = &functions;
    VmaAllocator vma = VK_NULL_HANDLE;
    if (vmaCreateAllocator(&info, &vma) != VK_SUCCESS)
        return 1;
    Adapter adapter(vma);
    voile::Handles handles = handles_of(engine);
    handles.buffer_allocator = &adapter;
    const int failed = let_a_sheet_fall(engine, handles);
    std::printf("%d buffers from the host's allocator, %d left\n", adapter.made(), adapter.alive());
    vmaDestroyAllocator(vma);
    return failed != 0 || adapter.made() == 0 || adapter.alive() != 0 ? 1 : 0;
}
