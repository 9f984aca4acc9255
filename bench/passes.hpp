// The GPU time of each pass of a step.
#pragma once

#include "timed_queue.hpp"

#include "voile/solver.hpp"

#include <map>
#include <string>
#include <vector>

namespace bench
{

struct Settings
{
    uint32_t workgroup_size = 0; // threads
    bool passes = false;         // print_passes when the measurement begins
    bool reuse = false;          // SolverOptions::command_reuse
};

// The time of each pass of a step. Timestamps keep passes from overlapping, so the sum exceeds the time of a step.
class PassTimes
{
public:
    explicit PassTimes(TimedQueue& queue);

    // Records a step. Read the times once it has completed.
    void record(VkCommandBuffer cmd, voile::Solver& solver, const voile::Step& step);
    void read();
    // The medians and means of all steps, in microseconds per substep.
    void print(uint32_t substeps) const;

private:
    voile::gpu::Timestamps timestamps_;
    std::map<std::string, std::vector<double>> times_; // us
};

// Prints the median time of each pass of a step, in microseconds per substep, over 21 steps from the same state.
// `restore` records the commands that restore the solver.
void print_passes(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, const TimedQueue::Record& restore);

} // namespace bench
