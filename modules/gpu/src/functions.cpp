// DeviceFunctions: loads each function by name.
#include "voile/gpu/functions.hpp"

#include <string>
#include <string_view>

namespace voile::gpu
{

namespace
{

PFN_vkVoidFunction find(PFN_vkGetDeviceProcAddr get, VkDevice device, std::string_view name)
{
    constexpr std::string_view k_extension = "KHR";
    if (const PFN_vkVoidFunction found = get(device, std::string(name).c_str()))
        return found;
    if (!name.ends_with(k_extension))
        return nullptr;
    name.remove_suffix(k_extension.size());
    return get(device, std::string(name).c_str());
}

} // namespace

DeviceFunctions load_device_functions(PFN_vkGetDeviceProcAddr get, VkDevice device)
{
    DeviceFunctions fn;
#define VOILE_LOAD_FUNCTION(name) fn.name = reinterpret_cast<PFN_##name>(find(get, device, #name))
    VOILE_COMPUTE_FUNCTIONS(VOILE_LOAD_FUNCTION)
    VOILE_ENGINE_FUNCTIONS(VOILE_LOAD_FUNCTION)
#undef VOILE_LOAD_FUNCTION
    return fn;
}

const char* missing_function(const DeviceFunctions& functions)
{
#define VOILE_CHECK_FUNCTION(name)                                                                                     \
    if (functions.name == nullptr)                                                                                     \
    return #name
    VOILE_COMPUTE_FUNCTIONS(VOILE_CHECK_FUNCTION)
#undef VOILE_CHECK_FUNCTION
    return nullptr;
}

} // namespace voile::gpu
