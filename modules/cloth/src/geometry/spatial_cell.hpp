// Cells of a grid in space, as keys.
#pragma once

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace voile
{

// The key of the cell of width `width` that has `p`. Cells 2^21 apart along an axis share a key.
inline uint64_t spatial_cell(const glm::vec3& p, float width)
{
    uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis)
        key = key << 21 | (static_cast<uint64_t>(static_cast<int64_t>(std::floor(p[axis] / width))) & 0x1fffff);
    return key;
}

} // namespace voile
