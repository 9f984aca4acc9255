// Context: borrowed handles, and the device functions and limits read from them.
#pragma once

#include "voile/export.hpp"
#include "voile/handles.hpp"

#include "voile/gpu/functions.hpp"

#include <memory>

namespace voile::gpu
{

// Handles plus the functions and limits read from them once. Copied freely; owns only an allocator, if the host
// lends none.
// All functions are found through the host's get_instance_proc_addr. No symbol of Vulkan is linked or defined: the host
// may link a loader, load one with volk or open one, and several devices can exist in one process.
struct Context
{
    Handles handles;
    DeviceFunctions fn;
    std::shared_ptr<BufferAllocator> buffers; // the host's, or one of the library's own
    VkPhysicalDeviceLimits limits{};
    VkPhysicalDeviceType device_type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    VkDeviceSize max_buffer_bytes = 0; // largest storage buffer that the device can bind and allocate
    bool texel_reads = false;          // kernels read through uniform texel buffers what they only read: llvmpipe

    // VK_EXT_debug_utils, null where the instance does not have it: labels and names are then left out.
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;

    [[nodiscard]] VkDevice device() const { return handles.device; }
};

// Makes an allocator if the host lends none, which serves buffers with `device_addresses` if the device has the feature
// bufferDeviceAddress on. Errors: a null handle, out of memory, or a device without the functions of
// Vulkan 1.2 and VK_KHR_synchronization2.
VOILE_GPU_API Result<Context> create_context(const Handles& handles, bool device_addresses = false);

// Gives `object` a name that validation messages and RenderDoc show. No-op without VK_EXT_debug_utils.
VOILE_GPU_API void set_name(const Context& context, VkObjectType type, uint64_t object, const char* name);

template <typename Handle>
void set_name(const Context& context, VkObjectType type, Handle object, const char* name)
{
    set_name(context, type, reinterpret_cast<uint64_t>(object), name);
}

// Returns "VK_ERROR_DEVICE_LOST" and so on, or the number of an unknown result.
VOILE_GPU_API std::string to_string(VkResult result);

} // namespace voile::gpu
