// What one case costs: GPU time, bytes, and the host's time to record it.
#pragma once

#include "cases.hpp"
#include "passes.hpp"
#include "timed_queue.hpp"

namespace bench
{

// A frame is 1/60 s of stable_substeps(1/60) substeps: one call of Solver::record.
struct Measurement
{
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    uint32_t substeps = 0;    // of a frame
    uint32_t dispatches = 0;  // of a frame
    uint32_t measured = 0;    // substeps in the command buffer that the GPU's time was taken of; fewer than a
                              // frame's on slow devices
    double visits = 0;        // nodes of an icosphere's hierarchy that a vertex visits where the measurement begins
    uint32_t contacts = 0;    // vertices that touch a collider where the measurement begins
    double gpu_median = 0;    // microseconds a substep; a `measured`-th of the normals pass is in it
    double gpu_p95 = 0;       // microseconds a substep
    double bytes = 0;         // a substep, by the model in measure.cpp
    double record_median = 0; // microseconds of the host a frame, in Solver::record alone
    uint64_t record_allocations = 0; // heap allocations in Solver::record after its first call, in all repetitions
};

// StartupError when the case cannot be made, is not in contact where it must be, or has values that are not finite.
Measurement measure(TimedQueue& queue, const Case& item, uint32_t repetitions, const Settings& settings);

} // namespace bench
