// The device of a host that links Vulkan: functions are called by their names. Vulkan 1.3, whose synchronization2 is
// switched on without the extension that it came from.
#pragma once

#include <vulkan/vulkan.h>

class HostDevice
{
public:
    HostDevice();
    ~HostDevice();
    HostDevice(const HostDevice&) = delete;
    HostDevice& operator=(const HostDevice&) = delete;

    VkCommandBuffer begin();
    void submit_and_wait(); // what was begun

    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queue_family = 0;

private:
    VkQueue queue_ = VK_NULL_HANDLE;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer cmd_ = VK_NULL_HANDLE;
};
