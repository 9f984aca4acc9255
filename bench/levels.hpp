// What it saves that a soft cloth takes fewer substeps than a stiff one.
#pragma once

#include "timed_queue.hpp"

#include <cstdint>
#include <vector>

namespace bench
{

// A soft sheet of side x side vertices beside a stiff one of 1,024. Milliseconds of the GPU per frame of 1/60 s,
// medians.
struct LevelsMeasurement
{
    uint32_t side = 0;
    uint32_t stiff_substeps = 0; // that the cloths need
    uint32_t soft_substeps = 0;
    double one_level = 0;  // both take as many as the stiff one needs
    double two_levels = 0; // each takes what it needs, with dispatches of its own
    double by_default = 0; // as the solver chooses
};

constexpr const char* k_levels_case = "levels"; // its name
// CPU devices: up to 128 x 128 vertices.
std::vector<LevelsMeasurement> measure_levels(TimedQueue& queue, uint32_t repetitions);

} // namespace bench
