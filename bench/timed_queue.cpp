// TimedQueue: one frame slot, one timed pass.
#include "timed_queue.hpp"

#include <algorithm>
#include <cmath>

namespace bench
{

TimedQueue::TimedQueue(const voile::engine::Device& device)
    : device_(device), frames_(device, 1),
      timestamps_(voile::engine::take(voile::gpu::Timestamps::create(device.context(), device.queue_family(), 1, 1)))
{
}

void TimedQueue::run(const Record& record)
{
    const voile::engine::FrameRing::Frame frame = frames_.begin();
    record(frame.cmd);
    frames_.submit(frame);
    frames_.wait(frame.slot);
}

double TimedQueue::time(const Record& record, const Record& before)
{
    run(
        [&](VkCommandBuffer cmd)
        {
            timestamps_.begin_frame(cmd, 0);
            if (before)
                before(cmd);
            const uint32_t pass = timestamps_.begin(cmd, "bench");
            record(cmd);
            timestamps_.end(cmd, pass);
        });
    const auto times = timestamps_.read(0);
    if (times.empty())
        throw voile::engine::StartupError("the device gave no timestamps");
    return times.front().milliseconds * 1000;
}

void TimedQueue::record_only(const Record& record)
{
    record(frames_.begin().cmd); // the next begin resets commands that were never submitted
}

double quantile(std::vector<double> values, double fraction)
{
    if (values.empty())
        return 0;
    std::sort(values.begin(), values.end());
    const auto rank = static_cast<size_t>(std::ceil(fraction * static_cast<double>(values.size())));
    return values[std::clamp<size_t>(rank, 1, values.size()) - 1];
}

} // namespace bench
