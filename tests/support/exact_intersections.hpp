// Intersecting pairs of edges and triangles, counted exactly on the CPU, independent of the module: a broad phase of
// its own, separating axes in whole numbers, and a filter in double.
#pragma once

#include "support/whole_number.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace tests
{

using EdgeEnds = std::array<glm::vec3, 2>;
using TriangleCorners = std::array<glm::vec3, 3>;

struct WholeVector
{
    Whole x;
    Whole y;
    Whole z;
};

inline WholeVector whole(const glm::vec3& v)
{
    return {Whole(v.x), Whole(v.y), Whole(v.z)};
}
inline WholeVector operator-(const WholeVector& a, const WholeVector& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline WholeVector cross(const WholeVector& a, const WholeVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Whole dot(const WholeVector& a, const WholeVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Whether a plane across the axis separates the edge strictly from the triangle. `points`: three corners, two ends, all
// relative to the first corner.
inline bool separates(const WholeVector& axis, const std::array<WholeVector, 5>& points)
{
    std::array<Whole, 5> along;
    for (size_t i = 0; i < 5; ++i)
        along[i] = dot(axis, points[i]);
    const auto [low, high] = std::minmax_element(along.begin(), along.begin() + 3);
    const auto [first, last] = std::minmax_element(along.begin() + 3, along.end());
    return *high < *first || *last < *low;
}

inline bool boxes_overlap(const EdgeEnds& e, const TriangleCorners& t)
{
    const glm::vec3 min = glm::min(e[0], e[1]);
    const glm::vec3 max = glm::max(e[0], e[1]);
    return glm::all(glm::lessThanEqual(min, glm::max(t[0], glm::max(t[1], t[2])))) &&
           glm::all(glm::lessThanEqual(glm::min(t[0], glm::min(t[1], t[2])), max));
}

// Whether the closed sets have a point in common. Two convex sets are apart if and only if an axis separates them: the
// triangle's normal or a cross product of edges; in a common plane the perpendiculars of the edges in it; on a common
// line the axes of the boxes. Axes of sets without an area or a length vanish and separate nothing.
inline bool intersect_by_axes(const EdgeEnds& e, const TriangleCorners& t)
{
    if (!boxes_overlap(e, t))
        return false;
    const WholeVector origin = whole(t[0]);
    std::array<WholeVector, 5> points;
    for (size_t i = 0; i < 3; ++i)
        points[i] = whole(t[i]) - origin;
    for (size_t i = 0; i < 2; ++i)
        points[3 + i] = whole(e[i]) - origin;
    const WholeVector along = points[4] - points[3];
    const std::array<WholeVector, 3> sides{points[1], points[2] - points[1], points[0] - points[2]};
    const WholeVector normal = cross(sides[0], sides[1]);
    const WholeVector around = cross(points[3], along); // of the plane through the edge and the first corner
    if (separates(normal, points) || separates(cross(normal, along), points) || separates(cross(around, along), points))
        return false;
    return std::none_of(sides.begin(), sides.end(),
                        [&](const WholeVector& side)
                        {
                            const WholeVector both = cross(along, side);
                            const WholeVector plane = cross(points[3], side);
                            return separates(both, points) || separates(cross(normal, side), points) ||
                                   separates(cross(both, along), points) || separates(cross(both, side), points) ||
                                   separates(cross(plane, side), points);
                        });
}

// The sign of a volume in double, or 0 if rounding may change it: the error is below 9 * 2^-53 of the absolute
// products.
inline int certain_sign(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d)
{
    const glm::dvec3 u = a - d;
    const glm::dvec3 v = b - d;
    const glm::dvec3 w = c - d;
    const glm::dvec3 left(v.y * w.z, v.z * w.x, v.x * w.y);
    const glm::dvec3 right(v.z * w.y, v.x * w.z, v.y * w.x);
    const double volume = glm::dot(u, left - right);
    const double size = glm::dot(glm::abs(u), glm::abs(left) + glm::abs(right));
    constexpr double k_error = 2e-15;
    return std::abs(volume) > k_error * size ? (volume > 0 ? 1 : -1) : 0;
}

// By signs in double, if all that decide are certain.
inline std::optional<bool> intersect_by_signs(const EdgeEnds& e, const TriangleCorners& t)
{
    const glm::dvec3 p(e[0]);
    const glm::dvec3 q(e[1]);
    const std::array<glm::dvec3, 3> c{glm::dvec3(t[0]), glm::dvec3(t[1]), glm::dvec3(t[2])};
    const int sides = certain_sign(c[0], c[1], c[2], p) * certain_sign(c[0], c[1], c[2], q);
    if (sides == 1)
        return false;
    const int turns = certain_sign(p, q, c[0], c[1]) + certain_sign(p, q, c[1], c[2]) + certain_sign(p, q, c[2], c[0]);
    if (sides == -1 && std::abs(turns) == 3)
        return true;
    return {};
}

inline bool intersect(const EdgeEnds& e, const TriangleCorners& t)
{
    if (!boxes_overlap(e, t))
        return false;
    const std::optional<bool> certain = intersect_by_signs(e, t);
    return certain ? *certain : intersect_by_axes(e, t);
}

// A mesh as a set of triangles and edges.
struct ExactMesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::vector<glm::uvec2> edges;
};

// `welded`: edges between the same positions are one.
// Coordinates are rounded to multiples of 2^-50 m, as statistics.hpp says.
inline ExactMesh exact_mesh(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles, bool welded = false)
{
    for (glm::vec3& p : positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = static_cast<float>(std::ldexp(std::nearbyint(std::ldexp(static_cast<double>(p[axis]), 50)), -50));
    ExactMesh mesh{std::move(positions), std::move(triangles), {}};
    using Key = std::tuple<float, float, float, uint32_t>; // an index alone, or a position alone
    std::set<std::pair<Key, Key>> known;
    const auto key = [&](uint32_t v)
    {
        const glm::vec3 p = mesh.positions[v] + 0.f; // -0 becomes 0
        return welded ? Key(p.x, p.y, p.z, 0) : Key(0.f, 0.f, 0.f, v);
    };
    for (const glm::uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
        {
            const glm::uvec2 edge(t[i], t[(i + 1) % 3]);
            if (known.insert(std::minmax(key(edge.x), key(edge.y))).second)
                mesh.edges.push_back(edge);
        }
    return mesh;
}

// Edges of one mesh and triangles of another, or of the same mesh without pairs that have a common vertex. A sweep
// along x finds the pairs whose boxes overlap. `use`: called with the numbers of an edge and a triangle that intersect.
template <typename Use>
void for_each_pair(const ExactMesh& edges, const ExactMesh& triangles, const Use& use)
{
    const bool same = &edges == &triangles;
    std::vector<float> starts(triangles.triangles.size());
    float widest = 0;
    const auto corners = [&](uint32_t t)
    {
        const glm::uvec3& c = triangles.triangles[t];
        return TriangleCorners{triangles.positions[c.x], triangles.positions[c.y], triangles.positions[c.z]};
    };
    for (uint32_t t = 0; t < starts.size(); ++t)
    {
        const TriangleCorners c = corners(t);
        starts[t] = std::min({c[0].x, c[1].x, c[2].x});
        widest = std::max(widest, std::max({c[0].x, c[1].x, c[2].x}) - starts[t]);
    }
    std::vector<uint32_t> order(starts.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return starts[a] < starts[b]; });
    for (uint32_t i = 0; i < edges.edges.size(); ++i)
    {
        const glm::uvec2 ends = edges.edges[i];
        const EdgeEnds e{edges.positions[ends.x], edges.positions[ends.y]};
        const float low = std::nextafter(std::min(e[0].x, e[1].x) - 1.001f * widest, -INFINITY);
        auto t = std::lower_bound(order.begin(), order.end(), low, [&](uint32_t a, float x) { return starts[a] < x; });
        for (; t != order.end() && starts[*t] <= std::max(e[0].x, e[1].x); ++t)
        {
            const glm::uvec3& c = triangles.triangles[*t];
            const bool connected =
                same && (glm::any(glm::equal(c, glm::uvec3(ends.x))) || glm::any(glm::equal(c, glm::uvec3(ends.y))));
            if (!connected && intersect(e, corners(*t)))
                use(i, *t);
        }
    }
}

inline uint64_t count_pairs(const ExactMesh& edges, const ExactMesh& triangles)
{
    uint64_t count = 0;
    for_each_pair(edges, triangles, [&](uint32_t, uint32_t) { ++count; });
    return count;
}

// Edges of each through triangles of the other.
inline uint64_t count_pairs_both_ways(const ExactMesh& a, const ExactMesh& b)
{
    return count_pairs(a, b) + count_pairs(b, a);
}

} // namespace tests
