// Surface: a mesh as files hold it, with faces of three or four corners and texture coordinates with seams.
#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace viewer
{

// Counter-clockwise seen from the normals' side.
struct Faces
{
    uint32_t corners = 3;                  // of each face
    std::vector<uint32_t> indices;         // of positions, `corners` per face
    std::vector<uint32_t> texture_indices; // of texture coordinates, one per index; empty: equal to `indices`

    [[nodiscard]] size_t count() const { return indices.size() / corners; }
};

Faces triangle_faces(const std::vector<glm::uvec3>& triangles);
// Quads. Vertex index = row * columns + column.
Faces grid_faces(uint32_t columns, uint32_t rows);
// Over the unit square. The first row is its upper border.
std::vector<glm::vec2> grid_texture_coordinates(uint32_t columns, uint32_t rows);

struct Surface
{
    std::string name;
    std::vector<glm::vec3> positions;           // m
    std::vector<glm::vec3> normals;             // one per position, or none
    std::vector<glm::vec2> texture_coordinates; // none: the faces have none
    Faces faces;
};

// Weighted by angle; a quad counts as two triangles.
std::vector<glm::vec3> surface_normals(const std::vector<glm::vec3>& positions, const Faces& faces);

} // namespace viewer
