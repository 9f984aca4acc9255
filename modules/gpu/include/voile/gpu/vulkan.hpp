// The one place where the Vulkan headers come in. Types alone are used: prototypes may be there, functions of a loader
// with the same names may be linked, and neither is called.
#pragma once

#include <vulkan/vulkan.h>

// The handles of VulkanMemoryAllocator, as its own header declares them. That header is included where memory is
// allocated.
VK_DEFINE_HANDLE(VmaAllocator)
VK_DEFINE_HANDLE(VmaAllocation)
