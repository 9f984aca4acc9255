// Includes the Vulkan headers. Nothing else does. Only types are used: prototypes may be declared and functions of a
// loader with the same names linked, and neither is called.
#pragma once

#include <vulkan/vulkan.h>

// The handles of VulkanMemoryAllocator, as its own header declares them. Only the code that allocates memory includes
// that header.
VK_DEFINE_HANDLE(VmaAllocator)
VK_DEFINE_HANDLE(VmaAllocation)
