// Ids: what a solver gives for what was added to it. A default-constructed id names nothing. An id that names nothing
// gives an error, or an empty answer where a function returns no Result (solver.hpp). An id belongs to the solver that
// gave it; another solver cannot tell it from its own.
#pragma once

#include <cstdint>

namespace voile
{

constexpr uint32_t k_no_index = UINT32_MAX;

struct ClothId
{
    uint32_t index = k_no_index;

    friend bool operator==(const ClothId&, const ClothId&) = default;
};

struct ColliderId
{
    uint32_t index = k_no_index;

    friend bool operator==(const ColliderId&, const ColliderId&) = default;
};

// A moving frame of the host's (a curtain rod, a bone, a hand); see Solver::add_anchor.
struct AnchorId
{
    uint32_t index = k_no_index;

    friend bool operator==(const AnchorId&, const AnchorId&) = default;
};

} // namespace voile
