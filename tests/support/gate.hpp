// Commands that the GPU has begun and cannot finish until the host lets it.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <thread>

namespace tests
{

class Gate
{
public:
    explicit Gate(voile::engine::Device& device)
        : device_(device), context_(device.context()), reached_(make()), opened_(make())
    {
        const auto get = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
            context_.handles.get_instance_proc_addr(context_.handles.instance, "vkGetDeviceProcAddr"));
        set_event_ = reinterpret_cast<PFN_vkSetEvent>(get(context_.device(), "vkSetEvent"));
    }
    ~Gate()
    {
        open();
        context_.fn.vkDeviceWaitIdle(context_.device());
        context_.fn.vkDestroyEvent(context_.device(), reached_, nullptr);
        context_.fn.vkDestroyEvent(context_.device(), opened_, nullptr);
    }
    Gate(const Gate&) = delete;
    Gate& operator=(const Gate&) = delete;

    // The commands that follow wait for `open`.
    void record(VkCommandBuffer cmd)
    {
        context_.fn.vkCmdSetEvent(cmd, reached_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
        context_.fn.vkCmdWaitEvents(cmd, 1, &opened_, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                                    nullptr, 0, nullptr, 0, nullptr);
    }

    // The GPU has begun to wait.
    void wait_until_reached()
    {
        while (context_.fn.vkGetEventStatus(context_.device(), reached_) != VK_EVENT_SET)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    // No validation message may be left to read: this clears the one about the event. The specification forbids it
    // since 2025 (VUID-vkSetEvent-event-09543), and has nothing else by which a host holds commands that have begun.
    void open()
    {
        CHECK(device_.validation().count() == 0);
        set_event_(context_.device(), opened_);
        device_.validation().clear();
    }

private:
    VkEvent make()
    {
        VkEventCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
        VkEvent event = VK_NULL_HANDLE;
        voile::engine::check(context_.fn.vkCreateEvent(context_.device(), &info, nullptr, &event), "event");
        return event;
    }

    voile::engine::Device& device_;
    const voile::gpu::Context& context_;
    VkEvent reached_;
    VkEvent opened_;
    PFN_vkSetEvent set_event_ = nullptr;
};

} // namespace tests
