// Includes the Vulkan headers. Only types are used: prototypes may be declared and functions of a loader with the same
// names linked, and neither is called. A host that uses volk, or any loader that wants VK_NO_PROTOTYPES, includes its
// loader's header before this one; the headers of the cloth module do not need that.
#pragma once

#include <vulkan/vulkan_core.h>
