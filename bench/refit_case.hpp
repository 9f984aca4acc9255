// Measures the refit of a deforming mesh's hierarchy.
#pragma once

#include "device_probe.hpp"
#include "timed_queue.hpp"

#include <span>
#include <string_view>

namespace bench
{

// A wavy sheet of columns x rows squares, two triangles each.
struct RefitCase
{
    const char* name = nullptr;
    const char* purpose = nullptr; // one line
    uint32_t columns = 0;
    uint32_t rows = 0;
    uint32_t workgroup_size = 256;
    bool shuffled = false; // vertices in random order
};

std::span<const RefitCase> refit_cases();
const RefitCase* find_refit_case(std::string_view name); // null if there is none

struct RefitMeasurement
{
    uint32_t vertices = 0;
    uint32_t triangles = 0;
    uint32_t dispatches = 0;
    double build = 0;      // host ms to build the tree, once
    double gpu_median = 0; // microseconds per refit
    double gpu_p95 = 0;    // microseconds
    double bytes = 0;      // per refit, by the model in refit_case.cpp
};

// The lower bound of a refit: its bytes at the copy's bandwidth plus its dispatches as if they were empty.
// Microseconds.
double refit_floor(const RefitMeasurement& measurement, const DeviceProbe& probe);

// StartupError if the root's box is not the box of all vertices.
RefitMeasurement measure_refit(TimedQueue& queue, const RefitCase& item, uint32_t repetitions);

} // namespace bench
