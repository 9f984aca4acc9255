// Padded trees: the hierarchy of a cloth, or of a collider that deforms. Its shape is made once, its boxes are refitted
// on the GPU.
#pragma once

#include "shared/padded_layout.h"

#include <glm/glm.hpp>

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

// The axis along which a range of triangles is halved.
enum class PaddedSplit
{
    smallest_area, // that for which both halves' boxes have the smallest sum of areas: the sum over all boxes is 3 to
                   // 11 % smaller than with the widest axis
    widest,        // about five times faster; as good for a flat grid
};

// Halves the triangles top down. Needs at least one triangle, fewer than 2^28, indices in range and finite positions.
// Deterministic.
PaddedTree build_padded_tree(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                             PaddedSplit split = PaddedSplit::smallest_area);

} // namespace voile
