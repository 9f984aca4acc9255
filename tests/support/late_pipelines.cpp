// A Vulkan layer that makes compute pipelines when they are first bound. Programs that tests start make all pipelines
// of a solver and bind a few of them, and a software device takes seconds to make them. See kept_pipelines.hpp, which
// does so within a process. Subjects that start programs name it in their environment (subjects.cmake); the programs
// outside of them make all pipelines in advance, as they do for users.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#define VOILE_LAYER_EXPORT extern "C" __attribute__((visibility("default")))

namespace
{

// A pipeline that is made when it is first bound.
struct Promise
{
    std::vector<uint32_t> code;
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<char> constants;
    std::string entry_point;
    std::string name;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline pipeline = VK_NULL_HANDLE;
};

// The next functions of the chain. A process has one instance and one device at a time.
struct Next
{
    VkInstance instance = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr instance_function = nullptr;
    PFN_vkGetDeviceProcAddr device_function = nullptr;

    std::mutex mutex;
    std::map<VkShaderModule, std::vector<uint32_t>> code; // of each module that was made last under its handle
    std::map<VkPipeline, std::unique_ptr<Promise>> promises;
};
Next next;

template <typename Function>
Function device_function(const char* name)
{
    return reinterpret_cast<Function>(next.device_function(next.device, name));
}

// The link of this layer in the chain, which is taken out of it.
template <typename Info>
Info* link_of(const void* create_info, VkStructureType type)
{
    const auto* at = static_cast<const VkBaseInStructure*>(create_info);
    for (at = at->pNext; at != nullptr; at = at->pNext)
        if (at->sType == type)
            if (auto* info = const_cast<Info*>(reinterpret_cast<const Info*>(at)); info->function == VK_LAYER_LINK_INFO)
                return info;
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance)
{
    auto* link = link_of<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr)
        return VK_ERROR_INITIALIZATION_FAILED;
    next.instance_function = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create =
        reinterpret_cast<PFN_vkCreateInstance>(next.instance_function(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    next.instance = *instance;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device)
{
    auto* link = link_of<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr)
        return VK_ERROR_INITIALIZATION_FAILED;
    next.device_function = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(next.instance_function(next.instance, "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    next.device = *device;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_module(VkDevice device, const VkShaderModuleCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkShaderModule* module)
{
    const auto create = device_function<PFN_vkCreateShaderModule>("vkCreateShaderModule");
    const VkResult result = create(device, info, allocator, module);
    const std::lock_guard lock(next.mutex);
    if (result == VK_SUCCESS)
        next.code[*module].assign(info->pCode, info->pCode + info->codeSize / sizeof(uint32_t));
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice, VkPipelineCache, uint32_t count,
                                                const VkComputePipelineCreateInfo* infos, const VkAllocationCallbacks*,
                                                VkPipeline* pipelines)
{
    const std::lock_guard lock(next.mutex);
    for (uint32_t i = 0; i < count; ++i)
    {
        auto promise = std::make_unique<Promise>();
        promise->code = next.code[infos[i].stage.module];
        promise->entry_point = infos[i].stage.pName;
        promise->layout = infos[i].layout;
        if (const VkSpecializationInfo* constants = infos[i].stage.pSpecializationInfo)
        {
            promise->entries.assign(constants->pMapEntries, constants->pMapEntries + constants->mapEntryCount);
            const auto* data = static_cast<const char*>(constants->pData);
            promise->constants.assign(data, data + constants->dataSize);
        }
        pipelines[i] = reinterpret_cast<VkPipeline>(promise.get());
        next.promises[pipelines[i]] = std::move(promise);
    }
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL set_name(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info)
{
    const std::lock_guard lock(next.mutex);
    const auto found = next.promises.find(reinterpret_cast<VkPipeline>(info->objectHandle));
    if (info->objectType != VK_OBJECT_TYPE_PIPELINE || found == next.promises.end())
        return device_function<PFN_vkSetDebugUtilsObjectNameEXT>("vkSetDebugUtilsObjectNameEXT")(device, info);
    found->second->name = info->pObjectName;
    return VK_SUCCESS;
}

// VK_NULL_HANDLE if it cannot be made, which ends the program at the latest when it is used.
void make(Promise& promise)
{
    VkShaderModuleCreateInfo module{};
    module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module.codeSize = promise.code.size() * sizeof(uint32_t);
    module.pCode = promise.code.data();
    const VkSpecializationInfo constants{static_cast<uint32_t>(promise.entries.size()), promise.entries.data(),
                                         promise.constants.size(), promise.constants.data()};
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = promise.entry_point.c_str();
    info.stage.pSpecializationInfo = &constants;
    info.layout = promise.layout;
    device_function<PFN_vkCreateShaderModule>("vkCreateShaderModule")(next.device, &module, nullptr,
                                                                      &info.stage.module);
    device_function<PFN_vkCreateComputePipelines>("vkCreateComputePipelines")(next.device, VK_NULL_HANDLE, 1, &info,
                                                                              nullptr, &promise.pipeline);
    device_function<PFN_vkDestroyShaderModule>("vkDestroyShaderModule")(next.device, info.stage.module, nullptr);
    const auto name = device_function<PFN_vkSetDebugUtilsObjectNameEXT>("vkSetDebugUtilsObjectNameEXT");
    if (promise.name.empty() || name == nullptr)
        return;
    VkDebugUtilsObjectNameInfoEXT named{};
    named.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
    named.objectType = VK_OBJECT_TYPE_PIPELINE;
    named.objectHandle = reinterpret_cast<uint64_t>(promise.pipeline);
    named.pObjectName = promise.name.c_str();
    name(next.device, &named);
}

VKAPI_ATTR void VKAPI_CALL bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    static const auto bind = device_function<PFN_vkCmdBindPipeline>("vkCmdBindPipeline");
    const std::lock_guard lock(next.mutex);
    if (const auto found = next.promises.find(pipeline); found != next.promises.end())
    {
        if (found->second->pipeline == VK_NULL_HANDLE)
            make(*found->second);
        pipeline = found->second->pipeline;
    }
    bind(cmd, point, pipeline);
}

VKAPI_ATTR void VKAPI_CALL destroy_pipeline(VkDevice device, VkPipeline pipeline,
                                            const VkAllocationCallbacks* allocator)
{
    const std::lock_guard lock(next.mutex);
    if (const auto found = next.promises.find(pipeline); found != next.promises.end())
    {
        pipeline = found->second->pipeline; // if any
        allocator = nullptr;
        next.promises.erase(found);
    }
    device_function<PFN_vkDestroyPipeline>("vkDestroyPipeline")(device, pipeline, allocator);
}

PFN_vkVoidFunction own_device_function(std::string_view name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_function(VkDevice device, const char* name)
{
    const PFN_vkVoidFunction below = next.device_function(device, name);
    const PFN_vkVoidFunction own = below != nullptr ? own_device_function(name) : nullptr;
    return own != nullptr ? own : below;
}

PFN_vkVoidFunction own_device_function(std::string_view name)
{
    if (name == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(&get_device_function);
    if (name == "vkCreateShaderModule")
        return reinterpret_cast<PFN_vkVoidFunction>(&create_module);
    if (name == "vkCreateComputePipelines")
        return reinterpret_cast<PFN_vkVoidFunction>(&create_pipelines);
    if (name == "vkCmdBindPipeline")
        return reinterpret_cast<PFN_vkVoidFunction>(&bind_pipeline);
    if (name == "vkDestroyPipeline")
        return reinterpret_cast<PFN_vkVoidFunction>(&destroy_pipeline);
    if (name == "vkSetDebugUtilsObjectNameEXT")
        return reinterpret_cast<PFN_vkVoidFunction>(&set_name);
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_function(VkInstance instance, const char* name)
{
    const std::string_view wanted = name;
    if (wanted == "vkGetInstanceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(&get_instance_function);
    if (wanted == "vkCreateInstance")
        return reinterpret_cast<PFN_vkVoidFunction>(&create_instance);
    if (wanted == "vkCreateDevice")
        return reinterpret_cast<PFN_vkVoidFunction>(&create_device);
    const PFN_vkVoidFunction below =
        next.instance_function != nullptr ? next.instance_function(instance, name) : nullptr;
    const PFN_vkVoidFunction own = below != nullptr ? own_device_function(wanted) : nullptr;
    return own != nullptr ? own : below;
}

} // namespace

VOILE_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated)
{
    negotiated->loaderLayerInterfaceVersion = 2;
    negotiated->pfnGetInstanceProcAddr = &get_instance_function;
    negotiated->pfnGetDeviceProcAddr = &get_device_function;
    negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
