// TimedQueue: commands submitted and waited for one at a time, with the GPU's time between two timestamps.
#pragma once

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"

#include "gpu/timestamps.hpp"

#include <functional>
#include <vector>

namespace bench
{

class TimedQueue
{
public:
    using Record = std::function<void(VkCommandBuffer)>;

    // StartupError if the queue has no timestamps.
    explicit TimedQueue(const engine::Device& device);

    [[nodiscard]] const gpu::Context& context() const { return device_.context(); }
    [[nodiscard]] const engine::Device& device() const { return device_; }

    void run(const Record& record);

    // Microseconds from the end of everything in `before` to the end of everything in `record`.
    double time(const Record& record, const Record& before = {});

    // Records and throws the commands away.
    void record_only(const Record& record);

private:
    const engine::Device& device_;
    engine::FrameRing frames_;
    gpu::Timestamps timestamps_;
};

// The smallest value that at least `share` of the values do not exceed (nearest rank). 0 for no values.
double quantile(std::vector<double> values, double share);

} // namespace bench
