// Open meshes over a square, for cases of the benchmark.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <cstdint>

namespace bench
{

constexpr float k_height_field_spacing = 0.01f; // m

// side x side vertices, row by row; `height(row, column)` in meters.
template <typename Height>
voile::engine::Mesh make_height_field(uint32_t side, const Height& height)
{
    voile::engine::Mesh mesh;
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column)
            mesh.positions.emplace_back(k_height_field_spacing * static_cast<float>(column), height(row, column),
                                        k_height_field_spacing * static_cast<float>(row));
    for (uint32_t row = 0; row + 1 < side; ++row)
        for (uint32_t column = 0; column + 1 < side; ++column)
        {
            const uint32_t a = row * side + column;
            const uint32_t b = a + side;
            mesh.triangles.emplace_back(a, b, a + 1);
            mesh.triangles.emplace_back(a + 1, b, b + 1);
        }
    return mesh;
}

} // namespace bench
