// GpuFixture: a device with validation and synchronization validation on, and one frame of commands at a time.
// Its destructor fails the test on any validation message.
#pragma once

#include "support/kept_pipelines.hpp"
#include "support/until_end.hpp"

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/download.hpp"
#include "voile/engine/gpu/frames.hpp"

#include "voile/gpu/allocator.hpp"
#include "voile/gpu/recorder.hpp"

#include <doctest/doctest.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace tests
{

// One per process: making a device takes longer than most tests. Tests run one after another.
inline voile::engine::Device& device()
{
    static auto& instance = UntilEnd::get().keep<voile::engine::Device>(
        voile::engine::DeviceOptions{.device = {}, .validation = true, .instance_extensions = {}, .swapchain = false});
    return instance;
}

// Fills new buffers with a word. The memory is visible to the host: slow on a GPU.
class FillingAllocator final : public voile::BufferAllocator
{
public:
    explicit FillingAllocator(uint32_t word)
        : word_(word), allocator_(voile::engine::take(voile::gpu::Allocator::create(device().context().handles)))
    {
    }

    voile::Result<voile::BufferMemory> create_buffer(const voile::BufferRequest& request) noexcept override
    {
        voile::BufferRequest visible = request;
        if (request.memory == voile::Memory::device)
            visible.memory = voile::Memory::upload;
        auto memory = allocator_->create_buffer(visible);
        if (memory)
            std::fill_n(static_cast<uint32_t*>(memory->mapped), request.bytes / sizeof(uint32_t), word_);
        return memory;
    }
    void destroy_buffer(const voile::BufferMemory& memory) noexcept override { allocator_->destroy_buffer(memory); }
    void flush(const voile::BufferMemory& memory) noexcept override { allocator_->flush(memory); }
    void invalidate(const voile::BufferMemory& memory) noexcept override { allocator_->invalidate(memory); }

private:
    uint32_t word_;
    std::unique_ptr<voile::gpu::Allocator> allocator_;
};

// NaN: a kernel that reads what nothing has written shows it in the positions.
constexpr uint32_t k_filled_nan = 0xffffffff;

// What solvers of the tests get: the device's handles with kept pipelines, and on a CPU buffers full of NaN.
inline voile::Handles test_handles()
{
    voile::Handles handles = KeptPipelines::handles(device().context());
    if (device().context().device_type != VK_PHYSICAL_DEVICE_TYPE_CPU)
        return handles;
    static auto& allocator = UntilEnd::get().keep<FillingAllocator>(k_filled_nan);
    handles.buffer_allocator = &allocator;
    return handles;
}

// For recorders that a test hands to a solver: a context whose functions know the solver's pipelines.
inline const voile::gpu::Context& solver_context()
{
    static const voile::gpu::Context context = voile::engine::take(voile::gpu::create_context(test_handles()));
    return context;
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
