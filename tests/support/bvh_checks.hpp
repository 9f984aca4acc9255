// Comparing hierarchies.
#pragma once

#include "geometry/bvh.hpp"

#include <cstring>

// Padding is part of the records, so bytes can be compared.
inline bool same_bits(const voile::Bvh& a, const voile::Bvh& b)
{
    const auto same = [](const auto& x, const auto& y)
    { return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0; };
    return same(a.nodes, b.nodes) && same(a.triangles, b.triangles) && a.depth == b.depth;
}
