// GpuFixture: a device with validation and synchronization validation on, and one frame of commands at a time.
// Its destructor fails the test on any validation message.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/download.hpp"
#include "voile/engine/gpu/frames.hpp"

#include "voile/gpu/recorder.hpp"

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include <functional>
#include <vector>

namespace tests
{

// One per process: making a device takes longer than most tests. Tests run one after another.
inline voile::engine::Device& device()
{
    static voile::engine::Device instance(
        {.device = {}, .validation = true, .instance_extensions = {}, .swapchain = false});
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

    [[nodiscard]] const voile::gpu::Context& context() const { return device().context(); }

    // Records, submits and waits.
    void run(const std::function<void(VkCommandBuffer)>& record)
    {
        const voile::engine::FrameRing::Frame frame = frames_.begin();
        record(frame.cmd);
        frames_.submit(frame);
        frames_.wait(frame.slot);
    }

    // The values of a device buffer with TRANSFER_SRC usage.
    template <typename T>
    std::vector<T> read(VkBuffer buffer, size_t count, VkDeviceSize offset = 0)
    {
        return voile::engine::download_values<T>(device(), buffer, offset, count);
    }

    uint32_t expected_messages = 0;

private:
    voile::engine::FrameRing frames_;
};

} // namespace tests
