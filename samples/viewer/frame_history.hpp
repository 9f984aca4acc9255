// FrameHistory: times and energy of the last frames, for the panel's plots.
#pragma once

#include "voile/gpu/timestamps.hpp"

#include <deque>
#include <span>
#include <string>
#include <vector>

namespace viewer
{

struct FrameSample
{
    float frame_ms = 0;             // GPU
    float energy = 0;               // J, kinetic
    std::vector<float> passes_ms{}; // one per name, in the order of FrameHistory::names; shorter if a name came later
};

class FrameHistory
{
public:
    static constexpr size_t k_frames = 240; // 4 s

    // The times of a frame that simulated. "frame" and "cloth" hold the others and are no passes of their own.
    void add(std::span<const voile::gpu::PassTime> times, float energy);
    void clear() { samples_.clear(); }

    [[nodiscard]] const std::deque<FrameSample>& samples() const { return samples_; } // the oldest first
    [[nodiscard]] const std::vector<std::string>& names() const { return names_; }    // of passes
    // The indices of the passes that took most of the time of all samples, the longest first.
    [[nodiscard]] std::vector<size_t> longest(size_t count) const;
    // ms of a frame, for a plot's height: 1.1 times what 19 of 20 frames take at most, so that single long ones do not
    // flatten it.
    [[nodiscard]] float usual_most() const;
    // ms per frame, the mean of all samples.
    [[nodiscard]] float mean(size_t pass) const;

private:
    std::vector<std::string> names_; // in the order of first use
    std::deque<FrameSample> samples_;
};

} // namespace viewer
