// The host's device.
#include "linked_host.hpp"

#include <cstdio>
#include <cstdlib>

namespace
{

void check(VkResult result, const char* what)
{
    if (result == VK_SUCCESS)
        return;
    std::fprintf(stderr, "%s: VkResult %d\n", what, result);
    std::exit(1);
}

uint32_t compute_family(VkPhysicalDevice device)
{
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    VkQueueFamilyProperties families[16];
    count = count < 16 ? count : 16;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0 &&
            (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) != 0)
            return i;
    std::fprintf(stderr, "no queue of graphics and compute\n");
    std::exit(1);
}

} // namespace

HostDevice::HostDevice()
{
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    instance_info.pApplicationInfo = &application;
    check(vkCreateInstance(&instance_info, nullptr, &instance), "instance");
    uint32_t count = 1;
    const VkResult found = vkEnumeratePhysicalDevices(instance, &count, &physical_device);
    check(found == VK_INCOMPLETE ? VK_SUCCESS : found, "physical devices");

    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue_info.queueFamilyIndex = queue_family = compute_family(physical_device);
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    features.synchronization2 = VK_TRUE;
    VkDeviceCreateInfo device_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    device_info.pNext = &features;
    device_info.queueCreateInfoCount = 1;
    device_info.pQueueCreateInfos = &queue_info;
    check(vkCreateDevice(physical_device, &device_info, nullptr, &device), "device");
    vkGetDeviceQueue(device, queue_info.queueFamilyIndex, 0, &queue_);

    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.queueFamilyIndex = queue_info.queueFamilyIndex;
    check(vkCreateCommandPool(device, &pool_info, nullptr, &pool_), "command pool");
}

HostDevice::~HostDevice()
{
    vkDestroyCommandPool(device, pool_, nullptr);
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
}

VkCommandBuffer HostDevice::begin()
{
    check(vkResetCommandPool(device, pool_, 0), "command pool");
    if (cmd_ == VK_NULL_HANDLE)
    {
        VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        info.commandPool = pool_;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        check(vkAllocateCommandBuffers(device, &info, &cmd_), "command buffer");
    }
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    check(vkBeginCommandBuffer(cmd_, &info), "command buffer");
    return cmd_;
}

void HostDevice::submit_and_wait()
{
    check(vkEndCommandBuffer(cmd_), "command buffer");
    VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    info.commandBufferCount = 1;
    info.pCommandBuffers = &cmd_;
    check(vkQueueSubmit(queue_, 1, &info, VK_NULL_HANDLE), "submission");
    check(vkQueueWaitIdle(queue_), "queue");
}
