// Which vertices of a mesh have the same position, and whether the mesh is closed.
#include "geometry/closedness.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <numeric>

namespace voile
{

namespace
{

constexpr size_t k_closedness_piece = 16384; // vertices or triangles per piece of work

uint64_t hash(const glm::vec3& p)
{
    const auto bits = std::bit_cast<std::array<uint32_t, 3>>(p + 0.f); // + 0: -0 and 0 are equal
    uint64_t h = (uint64_t{bits[1]} << 32 | bits[0]) * 0x9e3779b97f4a7c15u;
    h = (h ^ h >> 32 ^ bits[2]) * 0xbf58476d1ce4e5b9u;
    return h ^ h >> 29;
}

// Calls visit(low, high, upwards) for every edge of every triangle, `low` being the lower one of its vertices.
template <typename Visit>
void for_each_edge(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles, const Visit& visit)
{
    for (const glm::uvec3& t : triangles)
    {
        const glm::uvec3 v(welded[t.x], welded[t.y], welded[t.z]);
        for (int corner = 0; corner < 3; ++corner)
        {
            const uint32_t from = v[corner];
            const uint32_t to = v[(corner + 1) % 3];
            visit(std::min(from, to), std::max(from, to), from < to);
        }
    }
}

// Whether the `count` ends of edges that lead up from a vertex are those that lead down to it, each once.
bool paired(uint32_t* up, uint32_t* down, uint32_t count)
{
    std::sort(up, up + count);
    std::sort(down, down + count);
    return std::equal(up, up + count, down) && std::adjacent_find(up, up + count) == up + count;
}

} // namespace

std::vector<uint32_t> weld(std::span<const glm::vec3> positions)
{
    // Open addressing, at most half full: a node an entry would take several times as long.
    constexpr uint32_t k_empty = std::numeric_limits<uint32_t>::max();
    const size_t mask = std::bit_ceil(2 * positions.size() + 1) - 1;
    std::vector<uint32_t> table(mask + 1, k_empty);
    std::vector<uint32_t> result(positions.size());
    for (uint32_t i = 0; i < positions.size(); ++i)
    {
        size_t slot = hash(positions[i]) & mask;
        while (table[slot] != k_empty && positions[table[slot]] != positions[i])
            slot = (slot + 1) & mask;
        if (table[slot] == k_empty)
            table[slot] = i;
        result[i] = table[slot];
    }
    return result;
}

// Edges are grouped by their lower vertices, which have a few each. Sorting all of them as one list takes several times
// as long.
bool is_closed(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles)
{
    std::vector<uint32_t> first(welded.size() + 1); // of each vertex's entries in the lists below
    std::vector<uint32_t> downwards(welded.size() + 1);
    for_each_edge(welded, triangles,
                  [&](uint32_t low, uint32_t, bool upwards) { ++(upwards ? first : downwards)[low]; });
    if (first != downwards) // most open meshes return here
        return false;
    std::exclusive_scan(first.begin(), first.end(), first.begin(), 0u);
    std::vector<uint32_t> up(first.back());
    std::vector<uint32_t> down(first.back());
    std::vector<uint32_t> next_up = first;
    std::vector<uint32_t> next_down = first;
    for_each_edge(welded, triangles,
                  [&](uint32_t low, uint32_t high, bool upwards)
                  { (upwards ? up[next_up[low]++] : down[next_down[low]++]) = high; });
    std::atomic<bool> result = true;
    parallel_for(welded.size(), k_closedness_piece,
                 [&](size_t begin, size_t end)
                 {
                     for (size_t v = begin; v < end && result; ++v)
                         if (!paired(up.data() + first[v], down.data() + first[v], first[v + 1] - first[v]))
                             result = false;
                 });
    return result;
}

} // namespace voile
