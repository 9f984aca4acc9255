// Cloth meshes of the tests: sheets and closed surfaces, irregular on purpose, deterministic.
#pragma once

#include "voile/descriptions.hpp"

#include <glm/glm.hpp>

#include <cmath>
#include <random>
#include <vector>

namespace tests
{

struct ClothMesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    // Refers to this mesh, which must outlive it.
    [[nodiscard]] voile::MeshCloth cloth() const { return {.positions = positions, .triangles = triangles}; }
};

// Flat in x and z like a GridCloth of the given spacing, with parallel diagonals.
inline ClothMesh sheet(uint32_t columns, uint32_t rows, float spacing)
{
    ClothMesh mesh;
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            mesh.positions.emplace_back(spacing * static_cast<float>(column), 0, spacing * static_cast<float>(row));
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column + 1 < columns; ++column)
        {
            const uint32_t corner = row * columns + column;
            mesh.triangles.emplace_back(corner, corner + columns, corner + 1);
            mesh.triangles.emplace_back(corner + 1, corner + columns, corner + columns + 1);
        }
    return mesh;
}

inline void jitter(ClothMesh& mesh, float amount)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> offset(-amount, amount);
    for (glm::vec3& p : mesh.positions)
        p += glm::vec3(offset(random), offset(random), offset(random));
}

inline ClothMesh jittered_sheet(uint32_t columns, uint32_t rows)
{
    ClothMesh mesh = sheet(columns, rows, 0.05f);
    for (size_t t = 0; t + 1 < mesh.triangles.size(); t += 6) // every third cell has the other diagonal
    {
        const glm::uvec3 a = mesh.triangles[t];
        const glm::uvec3 b = mesh.triangles[t + 1];
        mesh.triangles[t] = {a.x, a.y, b.z};
        mesh.triangles[t + 1] = {a.x, b.z, a.z};
    }
    jitter(mesh, 0.012f);
    return mesh;
}

// Closed, with columns * rows vertices.
inline ClothMesh torus(uint32_t columns, uint32_t rows)
{
    ClothMesh mesh;
    const float tube = 0.05f * static_cast<float>(rows) / 6.2832f;
    const float ring = std::max(0.05f * static_cast<float>(columns) / 6.2832f, 1.6f * tube);
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
        {
            const float u = 6.2831853f * static_cast<float>(column) / static_cast<float>(columns);
            const float v = 6.2831853f * static_cast<float>(row) / static_cast<float>(rows);
            const float radius = ring + tube * std::cos(v);
            mesh.positions.emplace_back(radius * std::cos(u), tube * std::sin(v), radius * std::sin(u));
            const uint32_t right = row * columns + (column + 1) % columns;
            const uint32_t up = (row + 1) % rows * columns;
            const uint32_t self = row * columns + column;
            mesh.triangles.emplace_back(self, up + column, right);
            mesh.triangles.emplace_back(right, up + column, up + (column + 1) % columns);
        }
    jitter(mesh, 0.01f);
    return mesh;
}

inline ClothMesh tetrahedron()
{
    return {{{0, 0, 0}, {0.09f, 0.01f, 0}, {0.02f, 0, 0.08f}, {0.03f, 0.07f, 0.03f}},
            {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
}

} // namespace tests
