// What the host lends to the module: handles of its device, and optionally its allocator.
#pragma once

#include "voile/result.hpp"
#include "voile/vulkan_types.hpp"

#include <cstddef>

namespace voile
{

// Where a buffer's memory should be.
enum class Memory
{
    device,   // fast on the device, not visible to the host
    upload,   // written by the host front to back, read by the device
    readback, // written by the device, read by the host (cached)
};

struct BufferRequest
{
    VkDeviceSize bytes = 0;       // at least 16
    VkBufferUsageFlags usage = 0; // for VkBufferCreateInfo; the queue families are not shared. With
                                  // VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT the memory must be allocated with
                                  // VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT; only OutputOptions::usage asks for it
    Memory memory = Memory::device;
    const char* name = nullptr; // for messages and captures; only valid during the call. The module names the VkBuffer
};

// A buffer with its memory bound.
struct BufferMemory
{
    VkBuffer buffer{};
    void* mapped = nullptr;     // its first byte. Not null for Memory::upload and Memory::readback: these stay mapped
    void* allocation = nullptr; // the allocator's own, passed back to it
};

// Serves the buffers of solvers from the host's allocator. Without one the module has its own. The functions must not
// throw. Several threads call them at the same time if the host uses several solvers so. Nothing is allocated or freed
// while a step is recorded: only creating and destroying solvers, uploads and snapshots, and record_upload, do so, and
// set_attachments, set_tethers and add_anchor where the solver never had so many.
class BufferAllocator
{
public:
    // Errors are passed on by the call that needed the buffer; "out of memory" is enough, the module adds name and
    // size.
    virtual Result<BufferMemory> create_buffer(const BufferRequest& request) noexcept = 0;
    virtual void destroy_buffer(const BufferMemory& memory) noexcept = 0;

    // Of mapped memory, whole buffers: vkFlushMappedMemoryRanges and vkInvalidateMappedMemoryRanges where the memory is
    // not host-coherent.
    virtual void flush(const BufferMemory& memory) noexcept = 0;
    virtual void invalidate(const BufferMemory& memory) noexcept = 0;

protected:
    BufferAllocator() = default;
    ~BufferAllocator() = default; // the module never destroys the host's
    BufferAllocator(const BufferAllocator&) = default;
    BufferAllocator& operator=(const BufferAllocator&) = default;
};

// Handles that the host owns. All must outlive whatever is made from them.
struct Handles
{
    VkInstance instance{};
    VkPhysicalDevice physical_device{};
    VkDevice device{};
    VkPipelineCache pipeline_cache{}; // optional; not externally synchronized: several threads use it
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr; // the loader's, or a layer's
    BufferAllocator* buffer_allocator = nullptr;                // optional
};

} // namespace voile
