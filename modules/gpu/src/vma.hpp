// VulkanMemoryAllocator, declarations and implementation, with internal linkage: for the one source that includes it.
// Wherever the host has its own, of whatever version, neither sees the other.
#pragma once

#include "voile/gpu/vulkan.hpp"

// What VulkanMemoryAllocator includes must be included before, outside of the namespace below.
#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <shared_mutex>
#include <type_traits>
#include <utility>
#include <vulkan/vulkan.h>
#if defined(_MSC_VER)
#include <intrin.h>
#elif defined(__APPLE__)
#include <AvailabilityMacros.h>
#endif

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-variable"
#elif defined(_MSC_VER)
#pragma warning(push, 0)
#pragma warning(disable : 4505) // unreferenced functions
#endif

#define VMA_CALL_PRE static
#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_STATS_STRING_ENABLED 0
#define VMA_EXTERNAL_MEMORY_WIN32 0
#define VMA_IMPLEMENTATION

namespace
{
#include <vk_mem_alloc.h>
}

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#elif defined(_MSC_VER)
#pragma warning(pop)
#endif
