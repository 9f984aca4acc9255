// FrameRing: command buffers and fences of the frames in flight.
#include "voile/engine/gpu/frames.hpp"

namespace voile::engine
{

FrameRing::FrameRing(const Device& device, uint32_t slots) : device_(device), slots_(slots)
{
    const gpu::Context& context = device.context();
    for (Slot& slot : slots_)
    {
        VkCommandPoolCreateInfo pool_info{};
        pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
        pool_info.queueFamilyIndex = device.queue_family();
        check(context.fn.vkCreateCommandPool(context.device(), &pool_info, nullptr, &slot.pool), "command pool");

        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = slot.pool;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        check(context.fn.vkAllocateCommandBuffers(context.device(), &info, &slot.cmd), "command buffer");
        gpu::set_name(context, VK_OBJECT_TYPE_COMMAND_BUFFER, slot.cmd, "frame");

        VkFenceCreateInfo fence_info{};
        fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
        fence_info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
        check(context.fn.vkCreateFence(context.device(), &fence_info, nullptr, &slot.fence), "fence");
    }
}

FrameRing::~FrameRing()
{
    const gpu::Context& context = device_.context();
    // A lost device returns an error and has no work to wait for.
    (void)context.fn.vkDeviceWaitIdle(context.device());
    for (const Slot& slot : slots_)
    {
        context.fn.vkDestroyFence(context.device(), slot.fence, nullptr);
        context.fn.vkDestroyCommandPool(context.device(), slot.pool, nullptr);
    }
}

FrameRing::Frame FrameRing::begin()
{
    const gpu::Context& context = device_.context();
    const uint32_t index = next_;
    next_ = (next_ + 1) % slots();
    wait(index);
    const Slot& slot = slots_[index];
    check(context.fn.vkResetCommandPool(context.device(), slot.pool, 0), "command pool");
    VkCommandBufferBeginInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(context.fn.vkBeginCommandBuffer(slot.cmd, &info), "command buffer");
    return {slot.cmd, index};
}

void FrameRing::submit(const Frame& frame, VkSemaphore acquired, VkSemaphore rendered)
{
    const gpu::Context& context = device_.context();
    const Slot& slot = slots_[frame.slot];
    check(context.fn.vkEndCommandBuffer(frame.cmd), "command buffer");
    // Reset only here: a frame that fails before its submission leaves its fence signaled, so no wait is endless.
    check(context.fn.vkResetFences(context.device(), 1, &slot.fence), "fence");

    VkSemaphoreSubmitInfoKHR wait_info{};
    wait_info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO_KHR;
    wait_info.semaphore = acquired;
    wait_info.stageMask = VK_PIPELINE_STAGE_2_BLIT_BIT_KHR | VK_PIPELINE_STAGE_2_COPY_BIT_KHR;
    VkSemaphoreSubmitInfoKHR signal_info = wait_info;
    signal_info.semaphore = rendered;
    signal_info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT_KHR;
    VkCommandBufferSubmitInfoKHR cmd_info{};
    cmd_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO_KHR;
    cmd_info.commandBuffer = frame.cmd;
    VkSubmitInfo2KHR info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2_KHR;
    info.waitSemaphoreInfoCount = acquired != VK_NULL_HANDLE ? 1 : 0;
    info.pWaitSemaphoreInfos = &wait_info;
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &cmd_info;
    info.signalSemaphoreInfoCount = rendered != VK_NULL_HANDLE ? 1 : 0;
    info.pSignalSemaphoreInfos = &signal_info;
    check(context.fn.vkQueueSubmit2KHR(device_.queue(), 1, &info, slot.fence), "submission");
}

void FrameRing::wait(uint32_t slot) const
{
    const gpu::Context& context = device_.context();
    check(context.fn.vkWaitForFences(context.device(), 1, &slots_[slot].fence, VK_TRUE, UINT64_MAX), "frame");
}

void FrameRing::wait_all() const
{
    for (uint32_t i = 0; i < slots(); ++i)
        wait(i);
}

} // namespace voile::engine
