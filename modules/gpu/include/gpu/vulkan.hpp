// The one place where the Vulkan headers come in: through volk, without global prototypes.
#pragma once

#include <volk.h>

// VulkanMemoryAllocator is used through the functions that the host's allocator was made with.
#ifndef VMA_STATIC_VULKAN_FUNCTIONS
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#endif
#ifndef VMA_DYNAMIC_VULKAN_FUNCTIONS
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#endif
#include <vk_mem_alloc.h>
