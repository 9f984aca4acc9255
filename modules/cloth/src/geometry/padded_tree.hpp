// Padded trees: the hierarchy of a mesh that deforms. Its shape is made once, its boxes are refitted on the GPU.
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

// Halves the triangles top down, along the axis for which both halves' boxes have the smallest sum of areas: the sum
// over all boxes is 3 to 11 % smaller than with the widest axis. Needs at least one triangle, indices in range and
// finite positions. Deterministic.
PaddedTree build_padded_tree(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

} // namespace voile
