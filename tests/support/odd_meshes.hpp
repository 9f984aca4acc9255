// Cloth meshes with what modeling tools leave behind: T junctions, triangles that stand twice, open seams, vertices
// without triangles, edges of three and four triangles, triangles without area, slivers. The same bits on every
// machine.
#pragma once

#include "support/cloth_meshes.hpp"
#include "support/sliver_meshes.hpp"

#include <algorithm>
#include <array>

namespace tests
{

// Uneven numbers in -1..1, multiples of 2^-10.
class EvenRandom
{
public:
    float next()
    {
        state_ = state_ * 1664525 + 1013904223;
        return static_cast<float>(static_cast<int32_t>(state_ >> 21)) / 1024 - 1;
    }
    uint32_t below(uint32_t count)
    {
        return static_cast<uint32_t>(uint64_t{state_ = state_ * 1664525 + 1013904223} * count >> 32);
    }

private:
    uint32_t state_ = 11;
};

inline ClothMesh rough_sheet(uint32_t columns, uint32_t rows)
{
    ClothMesh mesh = sheet(columns, rows, 0.0625f);
    EvenRandom random;
    for (glm::vec3& p : mesh.positions)
        p += 0.0125f * glm::vec3(random.next(), random.next(), random.next());
    return mesh;
}

// Vertices and triangles in an order without any system.
inline void shuffle(ClothMesh& mesh)
{
    EvenRandom random;
    std::vector<uint32_t> new_index(mesh.positions.size());
    for (uint32_t i = 0; i < new_index.size(); ++i)
        new_index[i] = i;
    for (auto i = static_cast<uint32_t>(new_index.size()); i > 1; --i)
        std::swap(new_index[i - 1], new_index[random.below(i)]);
    std::vector<glm::vec3> positions(new_index.size());
    for (uint32_t i = 0; i < new_index.size(); ++i)
        positions[new_index[i]] = mesh.positions[i];
    mesh.positions = positions;
    for (glm::uvec3& t : mesh.triangles)
        t = {new_index[t.x], new_index[t.y], new_index[t.z]};
    for (auto i = static_cast<uint32_t>(mesh.triangles.size()); i > 1; --i)
        std::swap(mesh.triangles[i - 1], mesh.triangles[random.below(i)]);
}

// A vertex on the middle of an edge that the triangle below does not have.
inline ClothMesh t_junctions()
{
    ClothMesh mesh = rough_sheet(6, 6);
    add_inside(mesh, 6, 14, 0);
    add_inside(mesh, 6, 20, 0.001f);
    return mesh;
}

// The same triangle twice, turned round, and turned over.
inline ClothMesh doubled_triangles()
{
    ClothMesh mesh = rough_sheet(5, 4);
    const glm::uvec3 a = mesh.triangles[3];
    const glm::uvec3 b = mesh.triangles[8];
    mesh.triangles.push_back(a);
    mesh.triangles.emplace_back(b.z, b.x, b.y);
    mesh.triangles.emplace_back(a.x, a.z, a.y);
    return mesh;
}

// Two sheets that lie side by side with a column of their own each, and are not joined.
inline ClothMesh open_seam()
{
    ClothMesh mesh = rough_sheet(5, 5);
    const std::array<uint32_t, 5> seam{2, 7, 12, 17, 22};
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const uint32_t vertex : seam)
        mesh.positions.push_back(glm::vec3(mesh.positions[vertex]));
    for (glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            if (const uint32_t at = t[corner]; at % 5 == 2 && std::max({t.x % 5, t.y % 5, t.z % 5}) > 2 && at < first)
                t[corner] = first + at / 5;
    return mesh;
}

// A fan of four sheets around one edge, and two with only a vertex in common.
inline ClothMesh fan()
{
    ClothMesh mesh;
    mesh.positions = {{0, 0, 0},
                      {0.125f, 0, 0},
                      {0.0625f, 0.125f, 0},
                      {0.0625f, 0, 0.125f},
                      {0.0625f, -0.125f, 0},
                      {0.0625f, 0, -0.125f},
                      {-0.125f, 0.0625f, 0},
                      {-0.125f, -0.0625f, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}, {0, 6, 7}};
    return mesh;
}

// Vertices without triangles, triangles without area, and one with a vertex twice.
inline ClothMesh loose_ends()
{
    ClothMesh mesh = rough_sheet(4, 5);
    mesh.positions.insert(mesh.positions.begin(), {glm::vec3(9, 9, 9), glm::vec3(-0.0f, 0, 0)});
    for (glm::uvec3& t : mesh.triangles)
        t += 2u;
    const auto middle = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(0.5f * (mesh.positions[2] + mesh.positions[3]));
    mesh.positions.push_back(mesh.positions[5]);
    mesh.triangles.emplace_back(2, 3, middle);
    mesh.triangles.emplace_back(4, 4, 5);
    return mesh;
}

// Closed.
inline ClothMesh octahedron()
{
    ClothMesh mesh;
    mesh.positions = {{0.125f, 0, 0},   {-0.125f, 0, 0}, {0, 0.1875f, 0},
                      {0, -0.1875f, 0}, {0, 0, 0.25f},   {0, 0, -0.25f}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    return mesh;
}

inline ClothMesh slivers(Sliver sliver)
{
    ClothMesh mesh = rough_sheet(9, 9);
    for (glm::vec3& p : mesh.positions)
        p.y = 0;
    add_sliver(mesh, 9, 9, sliver, 1e-5f);
    return mesh;
}

inline ClothMesh shuffled_sheet()
{
    ClothMesh mesh = rough_sheet(23, 17);
    shuffle(mesh);
    return mesh;
}

} // namespace tests
