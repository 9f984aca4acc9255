// Sheets with one triangle of almost no height, like the output of modeling and cleanup tools.
#pragma once

#include "support/cloth_meshes.hpp"

#include <algorithm>

namespace tests
{

enum class Sliver
{
    none,
    loose,  // a separate piece, 3 cm long
    border, // along an edge of the border
    corner, // at a vertex of the border, which is its sharp end
    inside, // between two triangles, one of which has a vertex on the other's edge
    needle, // two, at the ends of an edge as short as the slivers are high
};
constexpr Sliver k_slivers[] = {Sliver::loose, Sliver::border, Sliver::corner, Sliver::inside, Sliver::needle};

// Splits the edge from `at` to its right neighbor, only for the triangle above it.
inline void add_inside(ClothMesh& mesh, uint32_t columns, uint32_t at, float height)
{
    const auto middle = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(0.5f * (mesh.positions[at] + mesh.positions[at + 1]) - glm::vec3(0, 0, height));
    const uint32_t above = at + 1 - columns;
    std::replace(mesh.triangles.begin(), mesh.triangles.end(), glm::uvec3(above, at, at + 1),
                 glm::uvec3(above, at, middle));
    mesh.triangles.emplace_back(above, middle, at + 1);
    mesh.triangles.emplace_back(at, at + 1, middle);
}

// Separates the sheet at a vertex: the triangles on its right get a copy of it.
inline void add_needle(ClothMesh& mesh, uint32_t columns, uint32_t at, float height)
{
    const auto copy = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[at] + glm::vec3(height, 0, 0));
    for (glm::uvec3& t : mesh.triangles)
    {
        const float middle = (mesh.positions[t.x].x + mesh.positions[t.y].x + mesh.positions[t.z].x) / 3;
        for (int corner = 0; corner < 3; ++corner)
            if (t[corner] == at && middle > mesh.positions[at].x)
                t[corner] = copy;
    }
    mesh.triangles.emplace_back(at - columns, at, copy);
    mesh.triangles.emplace_back(at, at + columns, copy);
}

// `height`: m, of the sliver.
inline void add_sliver(ClothMesh& mesh, uint32_t columns, uint32_t rows, Sliver sliver, float height)
{
    const uint32_t middle = rows / 2 * columns + columns / 2;
    const uint32_t border = (rows - 1) * columns + columns / 2;
    const auto added = static_cast<uint32_t>(mesh.positions.size());
    const glm::vec3 position = mesh.positions[border];
    const auto add = [&](float x, float z) { mesh.positions.push_back(position + glm::vec3(x, 0, z)); };
    if (sliver == Sliver::loose)
    {
        add(0, 0.5f);
        add(0.03f, 0.5f);
        add(0.015f, 0.5f + height);
        mesh.triangles.emplace_back(added, added + 2, added + 1);
    }
    if (sliver == Sliver::border)
    {
        add(0.5f * (mesh.positions[border + 1].x - position.x), height);
        mesh.triangles.emplace_back(border, added, border + 1);
    }
    if (sliver == Sliver::corner)
    {
        add(0, 0.03f);
        add(height, 0.03f);
        mesh.triangles.emplace_back(border, added, added + 1);
    }
    if (sliver == Sliver::inside)
        add_inside(mesh, columns, middle, height);
    if (sliver == Sliver::needle)
        add_needle(mesh, columns, middle, height);
}

// The sheet's own vertices come first.
inline ClothMesh sheet_with(uint32_t columns, uint32_t rows, float spacing, Sliver sliver, float height)
{
    ClothMesh mesh = sheet(columns, rows, spacing);
    add_sliver(mesh, columns, rows, sliver, height);
    return mesh;
}

} // namespace tests
