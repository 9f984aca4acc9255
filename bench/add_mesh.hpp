// What adding takes of the host: of a mesh collider preparing the mesh, building its hierarchy, copying both; of a
// cloth mesh finding its springs; of cooked ones loading them; of a small addition beside a large collider its upload.
#pragma once

#include "timed_queue.hpp"

#include "voile/engine/assets/mesh.hpp"
#include "voile/engine/gpu/device.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace bench
{

struct AddCase
{
    const char* name = nullptr;
    const char* purpose = nullptr; // one line
    voile::engine::Mesh (*make)() = nullptr;
    uint32_t repetitions = 0;
};
std::span<const AddCase> add_cases();
const AddCase* find_add_case(std::string_view name); // null if there is none

struct AddMeasurement
{
    size_t triangles = 0;
    double built_median = 0; // ms, with an empty cache
    double built_least = 0;  // ms; the median is the machine's other work too
    double again_median = 0; // ms, when the mesh was added before, to another solver
};

// Every repetition adds to a solver of its own. StartupError with the solver's message.
AddMeasurement measure_add(const voile::engine::Device& device, const AddCase& item);

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
