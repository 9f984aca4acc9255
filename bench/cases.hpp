// The benchmark's cases: the contents of a solver, and how far it runs before the measurement.
#pragma once

#include "voile/solver.hpp"

#include "voile/engine/assets/mesh.hpp"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace bench
{

struct Case
{
    const char* name = nullptr;
    const char* purpose = nullptr; // one line
    // Adds everything and returns the added cloths. StartupError with the solver's message.
    std::vector<voile::ClothId> (*build)(voile::Solver& solver) = nullptr;
    voile::ContactMethod method = voile::ContactMethod::nearest_point;
    uint32_t frames_before = 0; // frames of 1/60 s, simulated before the measurement
    bool in_contact = false;    // vertices must touch a collider then; the case is an error otherwise
    voile::MeshLayout layout = voile::MeshLayout::interleaved;
    float wind = 0; // m/s along x
    float gust = 0; // strength of the gusts, a fraction of the wind
    bool verlet = false;
    uint32_t lists = 0;                  // entries of a mesh vertex's list of springs
    std::optional<uint32_t> icosphere{}; // subdivisions of the icosphere below the drape scene's sheet
    // Where the vertices of the only cloth begin. No cloth may intersect itself at the measurement then; the case is an
    // error otherwise. Such cases run on a GPU or by their name.
    std::vector<glm::vec4> (*arrange)() = nullptr;
    bool asleep = false; // all cloths sleep at the measurement; the case is an error otherwise
};

// The icosphere of a case, radius 0.8 m.
voile::engine::Mesh case_icosphere(uint32_t subdivisions);

std::span<const Case> cases();

// Returns null if no case has this name.
const Case* find_case(std::string_view name);

} // namespace bench
