// DeviceFunctions: the functions of a device that this library and the engine call.
#pragma once

#include "voile/export.hpp"

#include "voile/gpu/vulkan.hpp"

namespace voile::gpu
{

// The functions of buffers, kernels, command buffers and timestamps. Every device has them.
#define VOILE_COMPUTE_FUNCTIONS(use)                                                                                   \
    use(vkAllocateCommandBuffers);                                                                                     \
    use(vkAllocateDescriptorSets);                                                                                     \
    use(vkBeginCommandBuffer);                                                                                         \
    use(vkCmdBindDescriptorSets);                                                                                      \
    use(vkCmdBindPipeline);                                                                                            \
    use(vkCmdCopyBuffer);                                                                                              \
    use(vkCmdDispatch);                                                                                                \
    use(vkCmdDispatchIndirect);                                                                                        \
    use(vkCmdExecuteCommands);                                                                                         \
    use(vkCmdFillBuffer);                                                                                              \
    use(vkCmdPipelineBarrier2KHR);                                                                                     \
    use(vkCmdPushConstants);                                                                                           \
    use(vkCmdResetEvent);                                                                                              \
    use(vkCmdResetQueryPool);                                                                                          \
    use(vkCmdSetEvent);                                                                                                \
    use(vkCmdUpdateBuffer);                                                                                            \
    use(vkCmdWriteTimestamp2KHR);                                                                                      \
    use(vkCreateBufferView);                                                                                           \
    use(vkCreateCommandPool);                                                                                          \
    use(vkCreateComputePipelines);                                                                                     \
    use(vkCreateDescriptorPool);                                                                                       \
    use(vkCreateDescriptorSetLayout);                                                                                  \
    use(vkCreateEvent);                                                                                                \
    use(vkCreatePipelineLayout);                                                                                       \
    use(vkCreateQueryPool);                                                                                            \
    use(vkCreateShaderModule);                                                                                         \
    use(vkDestroyBufferView);                                                                                          \
    use(vkDestroyCommandPool);                                                                                         \
    use(vkDestroyDescriptorPool);                                                                                      \
    use(vkDestroyDescriptorSetLayout);                                                                                 \
    use(vkDestroyEvent);                                                                                               \
    use(vkDestroyPipeline);                                                                                            \
    use(vkDestroyPipelineLayout);                                                                                      \
    use(vkDestroyQueryPool);                                                                                           \
    use(vkDestroyShaderModule);                                                                                        \
    use(vkEndCommandBuffer);                                                                                           \
    use(vkGetBufferDeviceAddress);                                                                                     \
    use(vkGetEventStatus);                                                                                             \
    use(vkGetQueryPoolResults);                                                                                        \
    use(vkUpdateDescriptorSets);

// The functions of the engine's submissions, pictures and windows.
#define VOILE_ENGINE_FUNCTIONS(use)                                                                                    \
    use(vkAcquireNextImageKHR);                                                                                        \
    use(vkCmdBeginRenderingKHR);                                                                                       \
    use(vkCmdBindIndexBuffer);                                                                                         \
    use(vkCmdBindVertexBuffers);                                                                                       \
    use(vkCmdBlitImage);                                                                                               \
    use(vkCmdCopyBufferToImage);                                                                                       \
    use(vkCmdCopyImageToBuffer);                                                                                       \
    use(vkCmdDraw);                                                                                                    \
    use(vkCmdDrawIndexed);                                                                                             \
    use(vkCmdEndRenderingKHR);                                                                                         \
    use(vkCmdSetScissor);                                                                                              \
    use(vkCmdSetViewport);                                                                                             \
    use(vkCmdWaitEvents);                                                                                              \
    use(vkCreateFence);                                                                                                \
    use(vkCreateGraphicsPipelines);                                                                                    \
    use(vkCreateImageView);                                                                                            \
    use(vkCreatePipelineCache);                                                                                        \
    use(vkCreateSampler);                                                                                              \
    use(vkCreateSemaphore);                                                                                            \
    use(vkCreateSwapchainKHR);                                                                                         \
    use(vkDestroyFence);                                                                                               \
    use(vkDestroyImageView);                                                                                           \
    use(vkDestroyPipelineCache);                                                                                       \
    use(vkDestroySampler);                                                                                             \
    use(vkDestroySemaphore);                                                                                           \
    use(vkDestroySwapchainKHR);                                                                                        \
    use(vkDeviceWaitIdle);                                                                                             \
    use(vkGetDeviceQueue);                                                                                             \
    use(vkGetSwapchainImagesKHR);                                                                                      \
    use(vkQueuePresentKHR);                                                                                            \
    use(vkQueueSubmit2KHR);                                                                                            \
    use(vkResetCommandPool);                                                                                           \
    use(vkResetFences);                                                                                                \
    use(vkWaitForFences);

struct DeviceFunctions
{
#define VOILE_DECLARE_FUNCTION(name) PFN_##name name = nullptr
    VOILE_COMPUTE_FUNCTIONS(VOILE_DECLARE_FUNCTION)
    VOILE_ENGINE_FUNCTIONS(VOILE_DECLARE_FUNCTION)
#undef VOILE_DECLARE_FUNCTION
};

// Loads the functions; null if the device lacks one. A function of an extension that a later Vulkan version promoted is
// found by either name.
VOILE_GPU_API DeviceFunctions load_device_functions(PFN_vkGetDeviceProcAddr get, VkDevice device);

// The first of VOILE_COMPUTE_FUNCTIONS that is null; null: none.
const char* missing_function(const DeviceFunctions& functions);

} // namespace voile::gpu
