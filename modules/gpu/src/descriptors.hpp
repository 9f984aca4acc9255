// The descriptors of a kernel's bindings.
#pragma once

#include "voile/gpu/shader_interface.hpp"
#include "voile/gpu/vulkan.hpp"

#include <algorithm>
#include <string>

namespace voile::gpu
{

// `number "name"`, the name where it is known.
inline std::string described(uint32_t number, const std::string& name)
{
    return std::to_string(number) + (name.empty() ? "" : " \"" + name + '"');
}

// Whether the storage buffer or uniform buffer is a descriptor: not where all that a kernel reads of it are texels.
inline bool has_buffer(const ShaderBinding& binding)
{
    return binding.texel_bytes == 0 || binding.texel_number != binding.number;
}

inline VkDescriptorType type_of(const ShaderBinding& binding)
{
    return binding.uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
}

// With those that are read as texels.
inline uint32_t count_storage_buffers(const std::vector<ShaderBinding>& bindings)
{
    return static_cast<uint32_t>(std::ranges::count(bindings, false, &ShaderBinding::uniform));
}

} // namespace voile::gpu
