// What adding and removing takes of the host: of a cloth mesh finding its springs; of cooked ones loading them; of
// small changes beside much else the change and its upload.
#pragma once

#include "timed_queue.hpp"

#include <vector>

namespace bench
{

// Milliseconds of the host, medians: by the clock, and of the processor on all threads.
struct HostCost
{
    const char* what = nullptr;
    size_t size = 0; // vertices of a cloth, triangles of a collider
    double clock = 0;
    double processor = 0;
};

constexpr const char* k_cost_case = "add-cost"; // its name
std::vector<HostCost> measure_costs(TimedQueue& queue);

} // namespace bench
