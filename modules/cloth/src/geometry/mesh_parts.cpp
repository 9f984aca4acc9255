// Turning the parts of a mesh that are inside-out.
#include "geometry/mesh_parts.hpp"

#include "geometry/parallel.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace voile
{

namespace
{

constexpr uint32_t k_none = std::numeric_limits<uint32_t>::max();
constexpr size_t k_part_piece = 16384; // triangles per piece of work

// For each vertex, the lowest one of its part. A vertex leads to a lower one, so that a chain ends.
std::vector<uint32_t> lowest_vertices(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles)
{
    std::vector<uint32_t> lower(welded.begin(), welded.end());
    const auto root = [&](uint32_t i)
    {
        while (lower[i] != i)
            i = lower[i] = lower[lower[i]];
        return i;
    };
    for (const glm::uvec3& t : triangles)
    {
        const glm::uvec3 roots(root(t.x), root(t.y), root(t.z));
        lower[roots.x] = lower[roots.y] = lower[roots.z] = std::min({roots.x, roots.y, roots.z});
    }
    for (uint32_t& i : lower) // those before it lead to the lowest one already
        i = lower[i];
    return lower;
}

double volume_under(std::span<const glm::vec3> positions, const glm::uvec3& t)
{
    const glm::dvec3 a = positions[t.x];
    const glm::dvec3 b = positions[t.y];
    const glm::dvec3 c = positions[t.z];
    return glm::dot(a, glm::cross(b, c)) / 6;
}

double volume_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles)
{
    std::vector<double> sums(triangles.size() / k_part_piece + 1); // in an order that does not depend on the threads
    parallel_for(triangles.size(), k_part_piece,
                 [&](size_t begin, size_t end)
                 {
                     double sum = 0;
                     for (size_t t = begin; t < end; ++t)
                         sum += volume_under(positions, triangles[t]);
                     sums[begin / k_part_piece] = sum;
                 });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// m^3, of each part; negative for one that is inside-out.
std::vector<double> volumes_of(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                               const MeshParts& parts)
{
    if (parts.count == 1)
        return {volume_of(positions, triangles)};
    std::vector<double> volumes(parts.count);
    for (size_t t = 0; t < triangles.size(); ++t)
        volumes[parts.of_triangles[t]] += volume_under(positions, triangles[t]);
    return volumes;
}

// Which parts are to be turned, from the outer ones to the inner ones.
std::vector<bool> inside_out_parts(std::span<const double> volumes, std::span<const std::vector<uint32_t>> enclosing)
{
    std::vector<uint32_t> order(volumes.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto shallower = [&](uint32_t a, uint32_t b) { return enclosing[a].size() < enclosing[b].size(); };
    std::sort(order.begin(), order.end(), shallower);
    std::vector<bool> turned(volumes.size());
    std::vector<int> solid(volumes.size()); // how often the parts around the inside of one wind around it; > 0: solid
    for (const uint32_t part : order)
    {
        int around = 0;
        if (!enclosing[part].empty())
        {
            const uint32_t parent = *std::max_element(enclosing[part].begin(), enclosing[part].end(), shallower);
            turned[part] = turned[parent];
            around = solid[parent];
        }
        const int sign = (volumes[part] < 0) != turned[part] ? -1 : 1;
        if (around + sign < 0)
            turned[part] = !turned[part];
        solid[part] = around + (around + sign < 0 ? 1 : sign);
    }
    return turned;
}

} // namespace

MeshParts find_parts(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles)
{
    const std::vector<uint32_t> lowest = lowest_vertices(welded, triangles);
    if (std::all_of(lowest.begin(), lowest.end(), [&](uint32_t i) { return i == 0; }))
        return {1, {}};
    MeshParts parts;
    parts.of_triangles.reserve(triangles.size());
    std::vector<uint32_t> numbers(lowest.size(), k_none);
    for (const glm::uvec3& t : triangles)
    {
        uint32_t& number = numbers[lowest[t.x]];
        if (number == k_none)
            number = parts.count++;
        parts.of_triangles.push_back(number);
    }
    if (parts.count == 1) // and vertices without triangles
        parts.of_triangles.clear();
    return parts;
}

void face_outwards(std::span<const glm::vec3> positions, std::span<const uint32_t> welded,
                   std::span<glm::uvec3> triangles)
{
    const MeshParts parts = find_parts(welded, triangles);
    const std::vector<double> volumes = volumes_of(positions, triangles, parts);
    if (std::none_of(volumes.begin(), volumes.end(), [](double volume) { return volume < 0; }))
        return;
    std::vector<bool> turned{true};
    if (parts.count > 1)
        turned = inside_out_parts(volumes, enclosing_parts(positions, triangles, parts));
    for (size_t t = 0; t < triangles.size(); ++t)
        if (parts.count == 1 || turned[parts.of_triangles[t]])
            std::swap(triangles[t].y, triangles[t].z);
}

} // namespace voile
