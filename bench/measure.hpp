// The cost of one case: GPU time, bytes, and the host's time to record it.
#pragma once

#include "cases.hpp"
#include "passes.hpp"
#include "timed_queue.hpp"

namespace bench
{

// A frame is 1/60 s in stable_substeps(1/60) substeps: one call of Solver::record.
struct Measurement
{
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    uint32_t substeps = 0;    // per frame
    uint32_t dispatches = 0;  // per frame
    uint32_t measured = 0;    // substeps in the timed command buffer; fewer than a frame's on slow devices
    double visits = 0;        // nodes of an icosphere's hierarchy that a vertex visits when the measurement begins
    uint32_t contacts = 0;    // vertices that touch a collider when the measurement begins
    double gpu_median = 0;    // microseconds per substep, including a `measured`-th of the normals pass
    double gpu_p95 = 0;       // microseconds per substep
    double bytes = 0;         // per substep, by the model in measure.cpp
    double record_median = 0; // host microseconds per frame, in Solver::record alone
    uint64_t record_allocations = 0; // heap allocations in Solver::record after its first call, in all repetitions
};

// StartupError if the case cannot be made, lacks a required contact, or has values that are not finite.
Measurement measure(TimedQueue& queue, const Case& item, uint32_t repetitions, const Settings& settings);

} // namespace bench
