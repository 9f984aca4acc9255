// The GPU time of each pass of a step.
#pragma once

#include "timed_queue.hpp"

#include "voile/solver.hpp"

namespace bench
{

struct Settings
{
    uint32_t workgroup_size = 0; // threads
    bool passes = false;         // print_passes when the measurement begins
};

// Prints the median time of each pass of a step, in microseconds per substep, over 21 steps from the same state.
// `restore` records the commands that restore the solver. Timestamps keep passes from overlapping, so the sum exceeds
// the time of a step.
void print_passes(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, const TimedQueue::Record& restore);

} // namespace bench
