// TimedQueue: submits commands and waits for them, one at a time, with the GPU time between two timestamps.
#pragma once

#include "voile/engine/gpu/device.hpp"
#include "voile/engine/gpu/frames.hpp"

#include "voile/gpu/timestamps.hpp"

#include <functional>
#include <vector>

namespace bench
{

inline constexpr float k_frame = 1.f / 60; // s

class TimedQueue
{
public:
    using Record = std::function<void(VkCommandBuffer)>;

    // StartupError if the queue has no timestamps.
    explicit TimedQueue(const voile::engine::Device& device);

    [[nodiscard]] const voile::gpu::Context& context() const { return device_.context(); }
    [[nodiscard]] const voile::engine::Device& device() const { return device_; }

    void run(const Record& record);

    // Microseconds from the end of everything in `before` to the end of everything in `record`.
    double time(const Record& record, const Record& before = {});

    // Records the commands and discards them.
    void record_only(const Record& record);

private:
    const voile::engine::Device& device_;
    voile::engine::FrameRing frames_;
    voile::gpu::Timestamps timestamps_;
};

// The smallest value that at least `fraction` of the values do not exceed (nearest rank). 0 for no values.
double quantile(std::vector<double> values, double fraction);

} // namespace bench
