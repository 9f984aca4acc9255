// What adding a mesh collider takes of the host: preparing the mesh, building its hierarchy, copying both.
#pragma once

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

} // namespace bench
