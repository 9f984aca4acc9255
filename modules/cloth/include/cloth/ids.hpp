// Ids: what a solver gives for what was added to it. An id is valid in the solver that gave it, and in no other. A
// default-constructed id is valid in none. Every function that takes an id says what it does with one that is not valid;
// none reads or writes memory by it.
#pragma once

#include <cstdint>

namespace cloth
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

} // namespace cloth
