// GpuFixture: a device with validation and synchronization validation on, and one frame of commands at a time.
// Its destructor fails the test on any validation message.
#pragma once

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"

#include "gpu/recorder.hpp"

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include <cstring>
#include <functional>
#include <vector>

namespace tests
{

// One a process: making a device takes longer than most tests. Tests run one after another.
inline engine::Device& device()
{
    static engine::Device instance({.device = {}, .validation = true, .instance_extensions = {}, .swapchain = false});
    return instance;
}

class GpuFixture
{
public:
    GpuFixture() : frames_(device(), 1) { device().validation().clear(); }

    ~GpuFixture()
    {
        device().wait_idle();
        for (const std::string& message : device().validation().messages())
            CAPTURE(message);
        CHECK(device().validation().count() == expected_messages);
    }

    [[nodiscard]] const gpu::Context& context() const { return device().context(); }

    // Records, submits and waits.
    void run(const std::function<void(VkCommandBuffer)>& record)
    {
        const engine::FrameRing::Frame frame = frames_.begin();
        record(frame.cmd);
        frames_.submit(frame);
        frames_.wait(frame.slot);
    }

    // The values of a device buffer that was made with TRANSFER_SRC usage.
    template <typename T>
    std::vector<T> read(VkBuffer buffer, size_t count, VkDeviceSize offset = 0)
    {
        const VkDeviceSize bytes = count * sizeof(T);
        gpu::Buffer host = engine::take(gpu::create_buffer(context(), "test readback", bytes,
                                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::Memory::readback));
        run(
            [&](VkCommandBuffer cmd)
            {
                const VkBufferCopy region{offset, 0, bytes};
                context().fn.vkCmdCopyBuffer(cmd, buffer, host.handle(), 1, &region);
                gpu::Recorder(context(), cmd)
                    .barrier(VK_PIPELINE_STAGE_2_COPY_BIT_KHR, VK_ACCESS_2_TRANSFER_WRITE_BIT_KHR,
                             VK_PIPELINE_STAGE_2_HOST_BIT_KHR, VK_ACCESS_2_HOST_READ_BIT_KHR);
            });
        host.invalidate();
        std::vector<T> values(count);
        std::memcpy(values.data(), host.mapped().data(), bytes);
        return values;
    }

    uint32_t expected_messages = 0;

private:
    engine::FrameRing frames_;
};

} // namespace tests
