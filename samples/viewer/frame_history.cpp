// FrameHistory.
#include "samples/viewer/frame_history.hpp"

#include <algorithm>
#include <numeric>

namespace viewer
{

void FrameHistory::add(std::span<const voile::gpu::PassTime> times, float energy)
{
    FrameSample sample;
    sample.energy = energy;
    for (const voile::gpu::PassTime& time : times)
    {
        const auto milliseconds = static_cast<float>(time.milliseconds);
        if (time.name == "frame")
            sample.frame_ms = milliseconds;
        if (time.name == "frame" || time.name == "cloth")
            continue;
        auto name = std::find(names_.begin(), names_.end(), time.name);
        if (name == names_.end())
            name = names_.insert(names_.end(), std::string(time.name));
        sample.passes_ms.resize(names_.size());
        sample.passes_ms[static_cast<size_t>(name - names_.begin())] += milliseconds;
    }
    samples_.push_back(std::move(sample));
    if (samples_.size() > k_frames)
        samples_.pop_front();
}

float FrameHistory::mean(size_t pass) const
{
    float sum = 0;
    for (const FrameSample& sample : samples_)
        sum += pass < sample.passes_ms.size() ? sample.passes_ms[pass] : 0;
    return samples_.empty() ? 0 : sum / static_cast<float>(samples_.size());
}

float FrameHistory::usual_most() const
{
    constexpr float k_least = 0.001f; // ms
    std::vector<float> times;
    for (const FrameSample& sample : samples_)
        times.push_back(sample.frame_ms);
    if (times.empty())
        return k_least;
    const auto usual = times.begin() + static_cast<std::ptrdiff_t>((times.size() - 1) * 19 / 20);
    std::nth_element(times.begin(), usual, times.end());
    return std::max(1.1f * *usual, k_least);
}

std::vector<size_t> FrameHistory::longest(size_t count) const
{
    std::vector<float> means(names_.size());
    for (size_t i = 0; i < means.size(); ++i)
        means[i] = mean(i);
    std::vector<size_t> order(names_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return means[a] > means[b]; });
    order.resize(std::min(count, order.size()));
    return order;
}

} // namespace viewer
