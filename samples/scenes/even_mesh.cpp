// Even triangles: the start from a box, moving vertices, flipping edges.
#include "even_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>

namespace scenes
{

namespace
{

constexpr glm::ivec3 k_squares{32, 32, 28}; // along x, y, z; 4 (32 * 32 + 32 * 28 + 32 * 28) = 11,264 triangles
constexpr int k_rounds = 80;

using Points = std::vector<glm::dvec3>;
using Triangles = std::vector<glm::uvec3>;

// The surface of a box as a grid of squares, shared vertices stored once.
class Box
{
public:
    Box()
    {
        for (int axis = 0; axis < 3; ++axis)
            for (const bool far : {false, true})
                add_side(axis, far);
    }

    Points points; // unit vectors
    Triangles triangles;

private:
    void add_side(int axis, bool far)
    {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (int i = 0; i < k_squares[u]; ++i)
            for (int j = 0; j < k_squares[v]; ++j)
            {
                const auto corner = [&](int di, int dj)
                {
                    glm::ivec3 at;
                    at[axis] = far ? k_squares[axis] : 0;
                    at[u] = i + di;
                    at[v] = j + dj;
                    return index_of(at);
                };
                const std::array<uint32_t, 4> square = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                add_square(square, far);
            }
    }

    void add_square(const std::array<uint32_t, 4>& s, bool far)
    {
        triangles.emplace_back(s[0], far ? s[1] : s[2], far ? s[2] : s[1]);
        triangles.emplace_back(s[0], far ? s[2] : s[3], far ? s[3] : s[2]);
    }

    uint32_t index_of(const glm::ivec3& at)
    {
        const auto [entry, is_new] =
            indices_.try_emplace(std::tuple(at.x, at.y, at.z), static_cast<uint32_t>(points.size()));
        if (is_new)
            points.push_back(glm::normalize(2. * glm::dvec3(at) / glm::dvec3(k_squares) - 1.));
        return entry->second;
    }

    std::map<std::tuple<int, int, int>, uint32_t> indices_;
};

// Lloyd's step: moves every vertex to the mean of its triangles' centers, weighted by area.
void relax(Points& points, const Triangles& triangles, const std::vector<bool>& is_fixed, const Projection& project)
{
    Points sums(points.size(), glm::dvec3(0.));
    std::vector<double> weights(points.size(), 0.);
    for (const glm::uvec3& t : triangles)
    {
        const glm::dvec3 middle = (points[t.x] + points[t.y] + points[t.z]) / 3.;
        const double area = glm::length(glm::cross(points[t.y] - points[t.x], points[t.z] - points[t.x]));
        for (int c = 0; c < 3; ++c)
        {
            sums[t[c]] += area * middle;
            weights[t[c]] += area;
        }
    }
    for (size_t i = 0; i < points.size(); ++i)
        if (!is_fixed[i])
            points[i] = project(sums[i] / weights[i]);
}

double cotangent_at(const Points& points, uint32_t at, uint32_t b, uint32_t c)
{
    const glm::dvec3 u = points[b] - points[at];
    const glm::dvec3 v = points[c] - points[at];
    return glm::dot(u, v) / glm::length(glm::cross(u, v));
}

// The start of each directed edge a -> b: triangle 3 t + corner. The triangle across has b -> a.
using Edges = std::unordered_map<uint64_t, uint32_t>;

uint64_t edge_key(uint32_t a, uint32_t b)
{
    return (uint64_t{a} << 32) | b;
}

Edges edges_of(const Triangles& triangles)
{
    Edges edges(3 * triangles.size());
    for (uint32_t t = 0; t < triangles.size(); ++t)
        for (uint32_t c = 0; c < 3; ++c)
            edges[edge_key(triangles[t][static_cast<int>(c)], triangles[t][static_cast<int>((c + 1) % 3)])] = 3 * t + c;
    return edges;
}

// Flips the edge from a corner of the triangle to the next if the angles opposite to it add up to more than 180
// degrees, which makes the sum of their cotangents negative, and if no edge joins the opposite vertices yet.
bool flip(const Points& points, Triangles& triangles, Edges& edges, uint32_t t, int c)
{
    const uint32_t a = triangles[t][c];
    const uint32_t b = triangles[t][(c + 1) % 3];
    const uint32_t left = triangles[t][(c + 2) % 3];
    const uint32_t across = edges.at(edge_key(b, a));
    const uint32_t other = across / 3;
    const uint32_t right = triangles[other][static_cast<int>((across + 2 - 3 * other) % 3)];
    constexpr double k_round = 1e-6; // avoids flipping back and forth between four vertices on a circle
    if (cotangent_at(points, left, a, b) + cotangent_at(points, right, a, b) >= -k_round ||
        edges.contains(edge_key(left, right)) || edges.contains(edge_key(right, left)))
        return false;
    edges.erase(edge_key(a, b));
    edges.erase(edge_key(b, a));
    triangles[t] = {left, a, right};
    triangles[other] = {right, b, left};
    for (const uint32_t changed : {t, other})
        for (uint32_t i = 0; i < 3; ++i)
            edges[edge_key(triangles[changed][static_cast<int>(i)],
                           triangles[changed][static_cast<int>((i + 1) % 3)])] = 3 * changed + i;
    return true;
}

void flip_to_delaunay(const Points& points, Triangles& triangles, Edges& edges)
{
    bool changed = true;
    for (int pass = 0; pass < 10 && changed; ++pass)
    {
        changed = false;
        for (uint32_t t = 0; t < triangles.size(); ++t)
            for (int c = 0; c < 3; ++c)
                changed |= flip(points, triangles, edges, t, c);
    }
}

} // namespace

void even_out(EvenMesh& mesh, const Projection& project, int rounds)
{
    Edges edges = edges_of(mesh.triangles);
    for (int round = 0; round < rounds; ++round)
    {
        flip_to_delaunay(mesh.points, mesh.triangles, edges);
        relax(mesh.points, mesh.triangles, mesh.is_fixed, project);
    }
    flip_to_delaunay(mesh.points, mesh.triangles, edges);
}

voile::engine::Mesh make_even_mesh(const Surface& surface)
{
    Box box;
    EvenMesh even{std::move(box.points), std::move(box.triangles), {}};
    for (glm::dvec3& point : even.points)
    {
        even.is_fixed.push_back(std::abs(point.x) + std::abs(point.z) < 1e-9);
        point = surface.from_sphere(point);
    }
    even_out(even, surface.from_space, k_rounds);
    voile::engine::Mesh mesh;
    mesh.positions.assign(even.points.begin(), even.points.end());
    mesh.triangles = std::move(even.triangles);
    return mesh;
}

} // namespace scenes
