// FrameRing: frames in flight. One primary command buffer and one fence per frame.
#pragma once

#include "voile/engine/gpu/device.hpp"

#include <vector>

namespace voile::engine
{

class FrameRing
{
public:
    FrameRing(const Device& device, uint32_t slots);
    ~FrameRing();
    FrameRing(const FrameRing&) = delete;
    FrameRing& operator=(const FrameRing&) = delete;

    struct Frame
    {
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        uint32_t slot = 0;
    };

    // Waits until the next slot's submission has completed, then begins its command buffer.
    Frame begin();

    // Ends and submits. With semaphores: waits for `acquired` before color output, signals `rendered`.
    void submit(const Frame& frame, VkSemaphore acquired = VK_NULL_HANDLE, VkSemaphore rendered = VK_NULL_HANDLE);

    // Waits for the submission of `slot`. Returns at once if there was none.
    void wait(uint32_t slot) const;
    void wait_all() const;

    [[nodiscard]] uint32_t slots() const { return static_cast<uint32_t>(slots_.size()); }

private:
    struct Slot
    {
        VkCommandPool pool = VK_NULL_HANDLE;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        VkFence fence = VK_NULL_HANDLE;
    };

    const Device& device_;
    std::vector<Slot> slots_;
    uint32_t next_ = 0;
};

} // namespace voile::engine
