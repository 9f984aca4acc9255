// Context: borrowed handles, and the device functions and limits read from them.
#pragma once

#include "voile/gpu/functions.hpp"
#include "voile/gpu/result.hpp"

namespace voile::gpu
{

// Handles of the host. They must outlive all objects made from them.
struct Handles
{
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VmaAllocator allocator = VK_NULL_HANDLE;
    VkPipelineCache pipeline_cache = VK_NULL_HANDLE;            // optional
    PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr; // the loader's, or a layer's
};

// Handles plus the functions and limits read from them once. Copied freely; owns nothing.
// All functions are found through the host's get_instance_proc_addr. No symbol of Vulkan is linked or defined: the host
// may link a loader, or load one with volk or by itself, and several devices can live in one process.
struct Context
{
    Handles handles;
    DeviceFunctions fn;
    VkPhysicalDeviceLimits limits{};
    VkPhysicalDeviceType device_type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    VkDeviceSize max_buffer_bytes = 0; // largest storage buffer that the device can bind and allocate

    // VK_EXT_debug_utils, null where the instance does not have it: labels and names are then left out.
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;
    PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;

    [[nodiscard]] VkDevice device() const { return handles.device; }
    [[nodiscard]] VmaAllocator allocator() const { return handles.allocator; }
};

// Errors: a null handle, or a device without the functions of Vulkan 1.2 and VK_KHR_synchronization2.
Result<Context> create_context(const Handles& handles);

// Gives `object` a name that validation messages and RenderDoc show. No-op without VK_EXT_debug_utils.
void set_name(const Context& context, VkObjectType type, uint64_t object, const char* name);

template <typename Handle>
void set_name(const Context& context, VkObjectType type, Handle object, const char* name)
{
    set_name(context, type, reinterpret_cast<uint64_t>(object), name);
}

// Returns "VK_ERROR_DEVICE_LOST" and so on, or the number of an unknown result.
std::string to_string(VkResult result);

} // namespace voile::gpu
