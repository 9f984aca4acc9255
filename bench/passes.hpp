// Where a step's time goes: the GPU's time of each pass.
#pragma once

#include "timed_queue.hpp"

#include "voile/solver.hpp"

namespace bench
{

struct Settings
{
    uint32_t workgroup_size = 0; // threads
    bool passes = false;         // print_passes where the measurement begins
};

// Prints the median time of each pass of a step, microseconds a substep, over 21 steps that begin alike: `restore`
// records what brings the solver back. Timestamps between passes keep these from overlapping, so that the sum is more
// than the step.
void print_passes(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, const TimedQueue::Record& restore);

} // namespace bench
