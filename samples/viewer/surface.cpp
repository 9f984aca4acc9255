// Faces of grids and meshes, and their normals.
#include "samples/viewer/surface.hpp"

#include "voile/engine/assets/normals.hpp"

namespace viewer
{

Faces triangle_faces(const std::vector<glm::uvec3>& triangles)
{
    Faces faces;
    faces.indices.reserve(3 * triangles.size());
    for (const glm::uvec3& t : triangles)
        faces.indices.insert(faces.indices.end(), {t.x, t.y, t.z});
    return faces;
}

Faces grid_faces(uint32_t columns, uint32_t rows)
{
    Faces faces;
    faces.corners = 4;
    faces.indices.reserve(size_t{4} * (columns - 1) * (rows - 1));
    for (uint32_t row = 0; row + 1 < rows; ++row)
        for (uint32_t column = 0; column + 1 < columns; ++column)
        {
            const uint32_t corner = row * columns + column;
            faces.indices.insert(faces.indices.end(), {corner, corner + columns, corner + columns + 1, corner + 1});
        }
    return faces;
}

std::vector<glm::vec2> grid_texture_coordinates(uint32_t columns, uint32_t rows)
{
    std::vector<glm::vec2> coordinates;
    coordinates.reserve(size_t{columns} * rows);
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            coordinates.emplace_back(static_cast<float>(column) / static_cast<float>(columns - 1),
                                     static_cast<float>(rows - 1 - row) / static_cast<float>(rows - 1));
    return coordinates;
}

std::vector<glm::vec3> surface_normals(const std::vector<glm::vec3>& positions, const Faces& faces)
{
    std::vector<glm::uvec3> triangles;
    triangles.reserve(faces.count() * (faces.corners - 2));
    for (size_t first = 0; first < faces.indices.size(); first += faces.corners)
        for (uint32_t i = 2; i < faces.corners; ++i)
            triangles.emplace_back(faces.indices[first], faces.indices[first + i - 1], faces.indices[first + i]);
    std::vector<glm::dvec3> sums;
    voile::engine::sum_normals(positions, triangles, sums);
    std::vector<glm::vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums)
        normals.push_back(voile::engine::unit_normal(sum));
    return normals;
}

} // namespace viewer
