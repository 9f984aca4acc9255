// Handles whose functions count the commands that a solver records.
#pragma once

#include "support/gpu_fixture.hpp"

#include <functional>
#include <string_view>

namespace tests
{

class CountedCommands
{
public:
    // Of a device that the process has one of. Functions are those of test_handles.
    static voile::Handles handles()
    {
        s_handles = test_handles();
        voile::Handles result = s_handles;
        result.get_instance_proc_addr = &instance_function;
        return result;
    }

    inline static uint32_t count = 0;
    inline static uint32_t begun = 0;                                // secondary command buffers
    inline static std::function<void(VkCommandBuffer)> in_execution; // called in vkCmdExecuteCommands, if any

private:
    // A function of Vulkan that adds to a counter first.
    template <uint32_t* Counter, auto Member, typename Function>
    struct Counted;
    template <uint32_t* Counter, auto Member, typename R, typename... Arguments>
    struct Counted<Counter, Member, R(VKAPI_PTR*)(Arguments...)>
    {
        static R VKAPI_CALL call(Arguments... arguments)
        {
            ++*Counter;
            return (s_functions.*Member)(arguments...);
        }
    };

    static void VKAPI_CALL execute(VkCommandBuffer cmd, uint32_t buffers, const VkCommandBuffer* secondary)
    {
        ++count;
        s_functions.vkCmdExecuteCommands(cmd, buffers, secondary);
        if (in_execution)
            in_execution(cmd);
    }

    static PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char* name)
    {
        if (std::string_view(name) == "vkGetDeviceProcAddr")
        {
            s_functions = solver_context().fn;
            s_get = reinterpret_cast<PFN_vkGetDeviceProcAddr>(s_handles.get_instance_proc_addr(instance, name));
            return reinterpret_cast<PFN_vkVoidFunction>(&device_function);
        }
        return s_handles.get_instance_proc_addr(instance, name);
    }

    static PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char* name)
    {
        const std::string_view wanted = name;
        if (wanted == "vkCmdExecuteCommands")
            return reinterpret_cast<PFN_vkVoidFunction>(&execute);
#define VOILE_COUNTED(function, counter)                                                                               \
    if (wanted == #function)                                                                                           \
    return reinterpret_cast<PFN_vkVoidFunction>(                                                                       \
        &Counted<&counter, &voile::gpu::DeviceFunctions::function, PFN_##function>::call)
        VOILE_COUNTED(vkBeginCommandBuffer, begun);
        VOILE_COUNTED(vkCmdBindDescriptorSets, count);
        VOILE_COUNTED(vkCmdBindPipeline, count);
        VOILE_COUNTED(vkCmdCopyBuffer, count);
        VOILE_COUNTED(vkCmdDispatch, count);
        VOILE_COUNTED(vkCmdDispatchIndirect, count);
        VOILE_COUNTED(vkCmdFillBuffer, count);
        VOILE_COUNTED(vkCmdPipelineBarrier2KHR, count);
        VOILE_COUNTED(vkCmdPushConstants, count);
        VOILE_COUNTED(vkCmdUpdateBuffer, count);
#undef VOILE_COUNTED
        return s_get(device, name);
    }

    inline static voile::Handles s_handles;
    inline static voile::gpu::DeviceFunctions s_functions;
    inline static PFN_vkGetDeviceProcAddr s_get = nullptr;
};

} // namespace tests
