// Context: reads functions and limits from the host's handles, names objects, converts results to text.
#include "voile/gpu/context.hpp"

#include "voile/gpu/allocator.hpp"

#include <algorithm>

namespace voile::gpu
{

namespace
{

template <typename Function>
Function instance_function(const Handles& handles, const char* name)
{
    return reinterpret_cast<Function>(handles.get_instance_proc_addr(handles.instance, name));
}

VkDeviceSize largest_storage_buffer(const Handles& handles, const VkPhysicalDeviceLimits& limits)
{
    const auto get =
        instance_function<PFN_vkGetPhysicalDeviceMemoryProperties>(handles, "vkGetPhysicalDeviceMemoryProperties");
    VkPhysicalDeviceMemoryProperties memory{};
    get(handles.physical_device, &memory);
    VkDeviceSize largest_heap = 0;
    for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        largest_heap = std::max(largest_heap, memory.memoryHeaps[i].size);
    return std::min<VkDeviceSize>(largest_heap, limits.maxStorageBufferRange);
}

// Whether the driver loads from storage buffers one component of one thread at a time.
bool loads_scalars(const Handles& handles)
{
    const auto get = instance_function<PFN_vkGetPhysicalDeviceProperties2>(handles, "vkGetPhysicalDeviceProperties2");
    if (get == nullptr)
        return false;
    VkPhysicalDeviceDriverProperties driver{};
    driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &driver;
    get(handles.physical_device, &properties);
    return driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE;
}

} // namespace

Result<Context> create_context(const Handles& handles, bool device_addresses)
{
    if (handles.instance == VK_NULL_HANDLE || handles.physical_device == VK_NULL_HANDLE ||
        handles.device == VK_NULL_HANDLE)
        return Error{"Handles: instance, physical_device and device must all be set"};
    if (handles.get_instance_proc_addr == nullptr)
        return Error{"Handles: get_instance_proc_addr is null"};

    Context context;
    context.handles = handles;
    const auto get = instance_function<PFN_vkGetDeviceProcAddr>(handles, "vkGetDeviceProcAddr");
    if (get == nullptr)
        return Error{"Handles: get_instance_proc_addr finds no vkGetDeviceProcAddr"};
    context.fn = load_device_functions(get, handles.device);
    if (context.fn.vkCmdPipelineBarrier2KHR == nullptr)
        return Error{"the device was made without VK_KHR_synchronization2, and not for Vulkan 1.3, which has it"};
    if (const char* missing = missing_function(context.fn))
        return Error{std::string("the device has no ") + missing};

    if (handles.buffer_allocator != nullptr) // borrowed: no owner counts it
        context.buffers = std::shared_ptr<BufferAllocator>(std::shared_ptr<void>(), handles.buffer_allocator);
    else if (auto own = Allocator::create(handles, device_addresses))
        context.buffers = std::shared_ptr<Allocator>(std::move(own.value()));
    else
        return own.error();

    VkPhysicalDeviceProperties properties{};
    instance_function<PFN_vkGetPhysicalDeviceProperties>(handles, "vkGetPhysicalDeviceProperties")(
        handles.physical_device, &properties);
    context.limits = properties.limits;
    context.device_type = properties.deviceType;
    context.texel_reads = loads_scalars(handles);
    context.max_buffer_bytes = largest_storage_buffer(handles, properties.limits);

    // An instance without VK_EXT_debug_utils returns null. Labels and names then do nothing.
    context.set_object_name =
        instance_function<PFN_vkSetDebugUtilsObjectNameEXT>(handles, "vkSetDebugUtilsObjectNameEXT");
    context.begin_label = instance_function<PFN_vkCmdBeginDebugUtilsLabelEXT>(handles, "vkCmdBeginDebugUtilsLabelEXT");
    context.end_label = instance_function<PFN_vkCmdEndDebugUtilsLabelEXT>(handles, "vkCmdEndDebugUtilsLabelEXT");
    return context;
}

void set_name(const Context& context, VkObjectType type, uint64_t object, const char* name)
{
    if (context.set_object_name == nullptr || object == 0)
        return;
    const VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT, nullptr, type, object,
                                             name};
    context.set_object_name(context.device(), &info);
}

std::string to_string(VkResult result)
{
    switch (result)
    {
    case VK_SUCCESS:
        return "VK_SUCCESS";
    case VK_NOT_READY:
        return "VK_NOT_READY";
    case VK_ERROR_UNKNOWN:
        return "VK_ERROR_UNKNOWN";
    case VK_TIMEOUT:
        return "VK_TIMEOUT";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_OUT_OF_POOL_MEMORY:
        return "VK_ERROR_OUT_OF_POOL_MEMORY";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "VK_ERROR_OUT_OF_DATE_KHR";
    default:
        return "VkResult " + std::to_string(static_cast<int>(result));
    }
}

} // namespace voile::gpu
