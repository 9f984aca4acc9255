#include "geometry/owned_edges.hpp"

#include <algorithm>

namespace voile
{

namespace
{

struct Side
{
    uint64_t edge; // both vertices, the smaller one first
    uint32_t triangle;
    uint32_t side;
};

Side side_of(std::span<const glm::uvec3> triangles, uint32_t triangle, int side)
{
    const auto [low, high] = std::minmax(triangles[triangle][side], triangles[triangle][(side + 1) % 3]);
    return {uint64_t{low} << 32 | high, triangle, static_cast<uint32_t>(side)};
}

} // namespace

std::vector<uint8_t> owned_edges(std::span<const glm::uvec3> triangles)
{
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (int side = 0; side < 3; ++side)
            sides.push_back(side_of(triangles, t, side));
    std::ranges::stable_sort(sides, {}, &Side::edge);
    std::vector<uint8_t> owned(triangles.size());
    for (size_t i = 0; i < sides.size(); ++i)
        if (i == 0 || sides[i].edge != sides[i - 1].edge)
            owned[sides[i].triangle] = static_cast<uint8_t>(owned[sides[i].triangle] | 1u << sides[i].side);
    return owned;
}

} // namespace voile
