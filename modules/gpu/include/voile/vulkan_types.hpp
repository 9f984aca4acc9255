// The types of Vulkan that the public headers name, declared as Vulkan's own headers declare them. Vulkan's headers are
// not included: whether they declare functions or leave them to a loader such as volk is the choice of whoever includes
// them first, and that is the host, before or after these headers.
#pragma once

#if !defined(VULKAN_CORE_H_)

#include <vulkan/vk_platform.h> // calling conventions; no types

#include <cstdint>

extern "C"
{
    typedef struct VkInstance_T* VkInstance;
    typedef struct VkPhysicalDevice_T* VkPhysicalDevice;
    typedef struct VkDevice_T* VkDevice;
    typedef struct VkCommandBuffer_T* VkCommandBuffer;

// These handles are integers where pointers have 32 bits.
#if UINTPTR_MAX > 0xffffffffu
    typedef struct VkBuffer_T* VkBuffer;
    typedef struct VkPipelineCache_T* VkPipelineCache;
#else
    typedef uint64_t VkBuffer;
    typedef uint64_t VkPipelineCache;
#endif

    typedef uint32_t VkFlags;
    typedef uint64_t VkFlags64;
    typedef uint64_t VkDeviceSize;
    typedef uint64_t VkDeviceAddress;
    typedef VkFlags VkBufferUsageFlags;
    typedef VkFlags64 VkPipelineStageFlags2;
    typedef VkFlags64 VkAccessFlags2;

    typedef void(VKAPI_PTR* PFN_vkVoidFunction)(void);
    typedef PFN_vkVoidFunction(VKAPI_PTR* PFN_vkGetInstanceProcAddr)(VkInstance instance, const char* pName);
}

#endif
