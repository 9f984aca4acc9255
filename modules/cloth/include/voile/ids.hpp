// Ids of the cloths, colliders, anchors and outputs of a solver.
//
// A default-constructed id is not valid, nor is the id of something that was removed. A later addition may get the same
// index with another generation. For an invalid id, functions return an error, or an empty value if they return no
// Result (solver.hpp). An id is valid for the solver that returned it. Other solvers cannot detect that it is not
// theirs.
#pragma once

#include <cstdint>

namespace voile
{

constexpr uint32_t k_no_index = UINT32_MAX;

struct ClothId
{
    uint32_t index = k_no_index;
    uint32_t generation = 0; // raised each time that the index becomes free

    friend bool operator==(const ClothId&, const ClothId&) = default;
};

struct ColliderId
{
    uint32_t index = k_no_index;
    uint32_t generation = 0; // raised each time that the index becomes free

    friend bool operator==(const ColliderId&, const ColliderId&) = default;
};

// A frame that the host moves: a curtain rod, a bone, a hand. See Solver::add_anchor.
struct AnchorId
{
    uint32_t index = k_no_index;
    uint32_t generation = 0; // raised each time that the index becomes free

    friend bool operator==(const AnchorId&, const AnchorId&) = default;
};

// A vertex buffer of the host that a cloth writes to. See Solver::add_output.
struct OutputId
{
    uint32_t index = k_no_index;
    uint32_t generation = 0; // raised each time that the index becomes free

    friend bool operator==(const OutputId&, const OutputId&) = default;
};

} // namespace voile
