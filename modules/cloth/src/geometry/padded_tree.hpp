// Padded trees: the hierarchy of a cloth, or of a collider that deforms. Its shape is made once, its boxes are refitted
// on the GPU.
#pragma once

#include "shared/padded_layout.h"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <vector>

namespace voile
{

struct PaddedTree
{
    std::vector<shared::PaddedLeaf> leaves; // 2^levels slots, in the order that padded_layout.h describes
    uint32_t triangles = 0;
    uint32_t levels = 0; // below the root

    [[nodiscard]] size_t boxes() const { return 2 * leaves.size() - 1; }
};

// The levels below the root of a tree over that many triangles, at least 1.
uint32_t padded_levels(uint32_t triangles);

// The trees of a table, ordered by their levels below the root: how many there are of each depth.
constexpr size_t k_tree_depths = 29;
using TreeCounts = std::array<uint32_t, k_tree_depths>;

// The first index from `first` on at which a tree's boxes can begin so that all of its levels but the top ones begin at
// multiples of 256 bytes: runs of boxes then fill whole cache lines.
constexpr uint32_t aligned_first_box(uint32_t first)
{
    constexpr uint32_t k_line = VOILE_REFIT_RUN;
    return (first + k_line - 2) / k_line * k_line + 1;
}

// The entries that boxes may need before their first one, so that it is aligned.
constexpr uint64_t k_box_alignment = VOILE_REFIT_RUN - 1;

// The axis along which a range of triangles is halved.
enum class PaddedSplit
{
    smallest_area, // that for which both halves' boxes have the smallest sum of areas: the sum over all boxes is 3 to
                   // 11 % smaller than with the widest axis
    widest,        // for flat grids: one sort per level instead of three
};

// Halves the triangles top down. Needs at least one triangle, fewer than 2^28, indices in range and finite positions.
// Deterministic.
PaddedTree build_padded_tree(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                             PaddedSplit split = PaddedSplit::smallest_area);

} // namespace voile
