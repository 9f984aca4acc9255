// Makes compute pipelines when they are first bound, and keeps them from one solver to the next. A software device
// takes longer to make those of a solver than most tests take to run, and most tests bind a few of them. Solvers get
// handles whose functions return a promise in place of a pipeline: of the same code with the same constants the same
// one. Shader modules of the same code are the same, too: the validation layer takes longer to check those of a solver
// than the rest of its creation takes. Nothing is destroyed before the last test has run. The viewer makes all
// pipelines in advance.
#pragma once

#include "support/until_end.hpp"

#include "voile/engine/gpu/device.hpp"

#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tests
{

class KeptPipelines
{
public:
    // The test device's handles, with functions that keep pipelines.
    static voile::Handles handles(const voile::gpu::Context& context)
    {
        static auto& kept = UntilEnd::get().keep<KeptPipelines>(context);
        return kept.handles();
    }

    // Of another device, which must live longer. One at a time: what solvers of others make meanwhile is made with it.
    explicit KeptPipelines(const voile::gpu::Context& context) : context_(context), fn_(context.fn)
    {
        const auto get = context.handles.get_instance_proc_addr;
        get_device_function_ =
            reinterpret_cast<PFN_vkGetDeviceProcAddr>(get(context.handles.instance, "vkGetDeviceProcAddr"));
    }

    KeptPipelines(const KeptPipelines&) = delete;
    KeptPipelines& operator=(const KeptPipelines&) = delete;

    // Before the device, which was made first.
    ~KeptPipelines()
    {
        for (const auto& [key, promise] : promises_)
            fn_.vkDestroyPipeline(context_.device(), promise->pipeline, nullptr); // if any
        for (const auto& [code, module] : modules_)
            fn_.vkDestroyShaderModule(context_.device(), module, nullptr);
        for (const VkPipelineLayout layout : layouts_)
            fn_.vkDestroyPipelineLayout(context_.device(), layout, nullptr);
        for (const VkDescriptorSetLayout layout : set_layouts_)
            fn_.vkDestroyDescriptorSetLayout(context_.device(), layout, nullptr);
    }

    voile::Handles handles()
    {
        s_kept = this;
        voile::Handles result = context_.handles;
        result.get_instance_proc_addr = &instance_function;
        return result;
    }

private:
    // A pipeline that is made when it is first bound.
    struct Promise
    {
        VkShaderModule module = VK_NULL_HANDLE;
        std::vector<VkSpecializationMapEntry> entries;
        std::vector<char> constants;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        std::string name;
        std::once_flag made;
        VkPipeline pipeline = VK_NULL_HANDLE;
    };

    static Promise& promise_of(VkPipeline handle) { return *reinterpret_cast<Promise*>(handle); }

    static PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name)
    {
        if (std::string_view(name) == "vkGetDeviceProcAddr")
            return reinterpret_cast<PFN_vkVoidFunction>(&device_function);
        const PFN_vkVoidFunction function = s_kept->context_.handles.get_instance_proc_addr(instance, name);
        if (function != nullptr && std::string_view(name) == "vkSetDebugUtilsObjectNameEXT")
            return reinterpret_cast<PFN_vkVoidFunction>(&set_name);
        return function;
    }

    static PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name)
    {
        const std::string_view wanted = name;
        if (wanted == "vkCreateShaderModule")
            return reinterpret_cast<PFN_vkVoidFunction>(&create_module);
        if (wanted == "vkDestroyShaderModule")
            return reinterpret_cast<PFN_vkVoidFunction>(&keep_module);
        if (wanted == "vkCreateComputePipelines")
            return reinterpret_cast<PFN_vkVoidFunction>(&create_pipeline);
        if (wanted == "vkCmdBindPipeline")
            return reinterpret_cast<PFN_vkVoidFunction>(&bind_pipeline);
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
        const std::string_view code(reinterpret_cast<const char*>(info->pCode), info->codeSize);
        const std::lock_guard lock(s_kept->mutex_);
        if (const auto kept = s_kept->modules_.find(code); kept != s_kept->modules_.end())
        {
            *module = kept->second;
            return VK_SUCCESS;
        }
        const VkResult result = s_kept->fn_.vkCreateShaderModule(device, info, allocator, module);
        if (result == VK_SUCCESS)
            s_kept->modules_.emplace(code, *module);
        return result;
    }

    // The module makes one pipeline per call.
    static VkResult VKAPI_CALL create_pipeline(VkDevice, VkPipelineCache, uint32_t,
                                               const VkComputePipelineCreateInfo* info, const VkAllocationCallbacks*,
                                               VkPipeline* pipeline)
    {
        const VkSpecializationInfo& constants = *info->stage.pSpecializationInfo;
        std::string key(reinterpret_cast<const char*>(&info->stage.module), sizeof(VkShaderModule));
        key.append(reinterpret_cast<const char*>(constants.pMapEntries),
                   constants.mapEntryCount * sizeof(VkSpecializationMapEntry));
        key.append(static_cast<const char*>(constants.pData), constants.dataSize);
        const std::lock_guard lock(s_kept->mutex_);
        std::unique_ptr<Promise>& promise = s_kept->promises_[key];
        if (!promise)
        {
            promise = std::make_unique<Promise>();
            promise->module = info->stage.module;
            promise->entries.assign(constants.pMapEntries, constants.pMapEntries + constants.mapEntryCount);
            const auto* data = static_cast<const char*>(constants.pData);
            promise->constants.assign(data, data + constants.dataSize);
            promise->layout = info->layout;
        }
        *pipeline = reinterpret_cast<VkPipeline>(promise.get());
        return VK_SUCCESS;
    }

    void make(Promise& promise) const
    {
        const VkSpecializationInfo constants{static_cast<uint32_t>(promise.entries.size()), promise.entries.data(),
                                             promise.constants.size(), promise.constants.data()};
        VkComputePipelineCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
        info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
        info.stage.module = promise.module;
        info.stage.pName = "main";
        info.stage.pSpecializationInfo = &constants;
        info.layout = promise.layout;
        const VkResult result =
            fn_.vkCreateComputePipelines(context_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &promise.pipeline);
        if (result != VK_SUCCESS)
            throw std::runtime_error("no pipeline \"" + promise.name + "\": VkResult " + std::to_string(result));
        voile::gpu::set_name(context_, VK_OBJECT_TYPE_PIPELINE, promise.pipeline, promise.name.c_str());
    }

    static void VKAPI_CALL bind_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
    {
        Promise& promise = promise_of(pipeline);
        std::call_once(promise.made,
                       [&]
                       {
                           const std::lock_guard lock(s_kept->mutex_); // the module may be named meanwhile
                           s_kept->make(promise);
                       });
        s_kept->fn_.vkCmdBindPipeline(cmd, point, promise.pipeline);
    }

    static VkResult VKAPI_CALL set_name(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info)
    {
        // Kernels share modules, and solvers share promises. Drivers replace the name of an object without a lock.
        const std::lock_guard lock(s_kept->mutex_);
        if (info->objectType != VK_OBJECT_TYPE_PIPELINE)
            return s_kept->context_.set_object_name(device, info);
        promise_of(reinterpret_cast<VkPipeline>(info->objectHandle)).name = info->pObjectName;
        return VK_SUCCESS;
    }

    static void VKAPI_CALL keep_module(VkDevice, VkShaderModule, const VkAllocationCallbacks*) {}
    static void VKAPI_CALL keep_pipeline(VkDevice, VkPipeline, const VkAllocationCallbacks*) {}
    static void VKAPI_CALL keep_layout(VkDevice, VkPipelineLayout layout, const VkAllocationCallbacks*)
    {
        const std::lock_guard lock(s_kept->mutex_);
        s_kept->layouts_.push_back(layout);
    }
    static void VKAPI_CALL keep_set_layout(VkDevice, VkDescriptorSetLayout layout, const VkAllocationCallbacks*)
    {
        const std::lock_guard lock(s_kept->mutex_);
        s_kept->set_layouts_.push_back(layout);
    }

    inline static KeptPipelines* s_kept = nullptr;

    const voile::gpu::Context& context_;
    voile::gpu::DeviceFunctions fn_;
    PFN_vkGetDeviceProcAddr get_device_function_ = nullptr;
    std::mutex mutex_; // of what follows: a solver makes its kernels on several threads
    std::map<std::string, VkShaderModule, std::less<>> modules_; // by code
    std::map<std::string, std::unique_ptr<Promise>> promises_;   // by module and constants
    std::vector<VkPipelineLayout> layouts_;
    std::vector<VkDescriptorSetLayout> set_layouts_;
};

} // namespace tests
