// Compiled once for each order in which a host may include the headers of the module, of Vulkan and of volk.
#if defined(ORDER_AFTER_VULKAN)
#include <vulkan/vulkan.h>
#elif defined(ORDER_AFTER_VOLK)
#include <volk.h>
#endif

#include <voile/cloth.hpp>

#if defined(ORDER_BEFORE_VULKAN)
#include <vulkan/vulkan.h>
#elif defined(ORDER_BEFORE_VOLK)
#include <volk.h>
#endif

// What the host made of Vulkan is what it has: functions, pointers, or nothing.
voile::Handles lend(VkInstance instance, PFN_vkGetInstanceProcAddr get);
voile::Handles lend(VkInstance instance, PFN_vkGetInstanceProcAddr get)
{
#if defined(ORDER_BEFORE_VULKAN) || defined(ORDER_AFTER_VULKAN)
    get = &vkGetInstanceProcAddr;
#elif defined(ORDER_BEFORE_VOLK) || defined(ORDER_AFTER_VOLK)
    get = vkGetInstanceProcAddr;
#endif
    return {.instance = instance, .get_instance_proc_addr = get};
}
