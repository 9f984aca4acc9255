// Keeps compute pipelines from one solver to the next. A software device takes longer to make those of a solver than
// most tests take to run. Solvers get handles whose functions return a pipeline that was made before from the same code
// with the same constants; nothing is destroyed before the process ends.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tests
{

class KeptPipelines
{
public:
    // The device's handles, with functions that keep pipelines. For one device per process.
    static voile::Handles handles(const voile::gpu::Context& context)
    {
        static KeptPipelines kept(context);
        s_kept = &kept;
        voile::Handles result = context.handles;
        result.get_instance_proc_addr = &instance_function;
        return result;
    }

private:
    explicit KeptPipelines(const voile::gpu::Context& context) : context_(context), fn_(context.fn)
    {
        const auto get = context.handles.get_instance_proc_addr;
        get_device_function_ =
            reinterpret_cast<PFN_vkGetDeviceProcAddr>(get(context.handles.instance, "vkGetDeviceProcAddr"));
    }

    // Before the device, which was made first.
    ~KeptPipelines()
    {
        for (const auto& [key, pipeline] : pipelines_)
            fn_.vkDestroyPipeline(context_.device(), pipeline, nullptr);
        for (const VkPipelineLayout layout : layouts_)
            fn_.vkDestroyPipelineLayout(context_.device(), layout, nullptr);
        for (const VkDescriptorSetLayout layout : set_layouts_)
            fn_.vkDestroyDescriptorSetLayout(context_.device(), layout, nullptr);
    }

    static PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name)
    {
        if (std::string_view(name) == "vkGetDeviceProcAddr")
            return reinterpret_cast<PFN_vkVoidFunction>(&device_function);
        return s_kept->context_.handles.get_instance_proc_addr(instance, name);
    }

    static PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name)
    {
        const std::string_view wanted = name;
        if (wanted == "vkCreateShaderModule")
            return reinterpret_cast<PFN_vkVoidFunction>(&create_module);
        if (wanted == "vkCreateComputePipelines")
            return reinterpret_cast<PFN_vkVoidFunction>(&create_pipeline);
        if (wanted == "vkDestroyPipeline")
            return reinterpret_cast<PFN_vkVoidFunction>(&keep_pipeline);
        if (wanted == "vkDestroyPipelineLayout")
            return reinterpret_cast<PFN_vkVoidFunction>(&keep_layout);
        if (wanted == "vkDestroyDescriptorSetLayout")
            return reinterpret_cast<PFN_vkVoidFunction>(&keep_set_layout);
        return s_kept->get_device_function_(device, name);
    }

    static VkResult VKAPI_CALL create_module(VkDevice device, const VkShaderModuleCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkShaderModule* module)
    {
        const VkResult result = s_kept->fn_.vkCreateShaderModule(device, info, allocator, module);
        if (result == VK_SUCCESS)
            s_kept->code_[*module].assign(reinterpret_cast<const char*>(info->pCode), info->codeSize);
        return result;
    }

    // The module makes one pipeline per call.
    static VkResult VKAPI_CALL create_pipeline(VkDevice device, VkPipelineCache cache, uint32_t count,
                                               const VkComputePipelineCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkPipeline* pipeline)
    {
        const VkSpecializationInfo& constants = *info->stage.pSpecializationInfo;
        std::string key = s_kept->code_[info->stage.module];
        key.append(reinterpret_cast<const char*>(constants.pMapEntries),
                   constants.mapEntryCount * sizeof(VkSpecializationMapEntry));
        key.append(static_cast<const char*>(constants.pData), constants.dataSize);
        const auto found = s_kept->pipelines_.find(key);
        if (found != s_kept->pipelines_.end())
        {
            *pipeline = found->second;
            return VK_SUCCESS;
        }
        const VkResult result = s_kept->fn_.vkCreateComputePipelines(device, cache, count, info, allocator, pipeline);
        if (result == VK_SUCCESS)
            s_kept->pipelines_.emplace(std::move(key), *pipeline);
        return result;
    }

    static void VKAPI_CALL keep_pipeline(VkDevice, VkPipeline, const VkAllocationCallbacks*) {}
    static void VKAPI_CALL keep_layout(VkDevice, VkPipelineLayout layout, const VkAllocationCallbacks*)
    {
        s_kept->layouts_.push_back(layout);
    }
    static void VKAPI_CALL keep_set_layout(VkDevice, VkDescriptorSetLayout layout, const VkAllocationCallbacks*)
    {
        s_kept->set_layouts_.push_back(layout);
    }

    inline static KeptPipelines* s_kept = nullptr;

    const voile::gpu::Context& context_;
    voile::gpu::DeviceFunctions fn_;
    PFN_vkGetDeviceProcAddr get_device_function_ = nullptr;
    std::unordered_map<VkShaderModule, std::string> code_; // of each module that was made last under its handle
    std::map<std::string, VkPipeline> pipelines_;          // by code and constants
    std::vector<VkPipelineLayout> layouts_;
    std::vector<VkDescriptorSetLayout> set_layouts_;
};

} // namespace tests
