// Isometric bending of a mesh in double precision: the quadratic form of its energy, assembled directly.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace reference
{

using VertexPair = std::pair<uint32_t, uint32_t>;
using Linear = std::map<uint32_t, double>;          // sum of coefficient * x over vertices
using QuadraticForm = std::map<VertexPair, double>; // both halves

// A triangle at an edge, and its vertex opposite to the edge.
struct MeshSide
{
    uint32_t opposite;
    glm::uvec3 triangle;
};
using MeshEdges = std::map<VertexPair, std::vector<MeshSide>>; // by the lower vertex, then the higher one

using Positions = std::span<const glm::dvec3>; // m

inline VertexPair ordered(uint32_t a, uint32_t b)
{
    return std::minmax({a, b});
}

inline double area(const glm::uvec3& t, Positions x)
{
    return 0.5 * glm::length(glm::cross(x[t.y] - x[t.x], x[t.z] - x[t.x]));
}

// The foot of the height from `opposite`, as a fraction of the edge from a to b.
inline double foot(Positions rest, uint32_t a, uint32_t b, uint32_t opposite)
{
    const glm::dvec3 along = rest[b] - rest[a];
    return glm::dot(rest[opposite] - rest[a], along) / glm::dot(along, along);
}

// From the foot to `opposite`.
inline glm::dvec3 height(Positions rest, uint32_t a, uint32_t b, uint32_t opposite)
{
    return rest[opposite] - glm::mix(rest[a], rest[b], foot(rest, a, b, opposite));
}

// The angle of a small fold times the edge's length, along the normal. Each side's height turns by the difference
// of foot and top over its length.
inline Linear fold(Positions rest, uint32_t a, uint32_t b, uint32_t first, uint32_t second)
{
    Linear result;
    for (const uint32_t opposite : {first, second})
    {
        const double t = foot(rest, a, b, opposite);
        const double turn = glm::distance(rest[a], rest[b]) / glm::length(height(rest, a, b, opposite));
        result[a] += turn * (1 - t);
        result[b] += turn * t;
        result[opposite] -= turn;
    }
    return result;
}

// 1/m^2. Energy of a triangle: 1/2 B A |S|^2, S = sum over its hinges of fold / 2A m m^T, m the edge's normal in its
// plane.
inline QuadraticForm bending_form(Positions rest, std::span<const glm::uvec3> triangles, const MeshEdges& edges)
{
    QuadraticForm form;
    for (const glm::uvec3& t : triangles)
    {
        const double around = area(t, rest);
        std::array<Linear, 9> curvature;
        for (int corner = 0; corner < 3; ++corner)
        {
            const auto [a, b] = ordered(t[corner], t[(corner + 1) % 3]);
            const uint32_t own = t[(corner + 2) % 3];
            const glm::dvec3 m = glm::normalize(height(rest, a, b, own));
            for (const MeshSide& side : edges.at({a, b}))
            {
                if (side.opposite == own)
                    continue;
                for (const auto& [vertex, coefficient] : fold(rest, a, b, own, side.opposite))
                    for (int k = 0; k < 9; ++k)
                        curvature[size_t(k)][vertex] += coefficient / (2 * around) * m[k / 3] * m[k % 3];
            }
        }
        for (const Linear& entry : curvature)
            for (const auto& [i, left] : entry)
                for (const auto& [j, right] : entry)
                    form[{i, j}] += around * left * right;
    }
    return form;
}

} // namespace reference
