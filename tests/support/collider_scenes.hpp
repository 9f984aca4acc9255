// Parts of the collider tests' scenes: sheets, mesh colliders, transforms, and error messages.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/engine/assets/mesh.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <string>
#include <variant>
#include <vector>

namespace tests
{

inline glm::mat4 moved(const glm::vec3& displacement)
{
    return glm::translate(glm::mat4(1.f), displacement);
}

// Both refer to the mesh, which must live until the collider is added.
inline voile::MeshCollider collider(const voile::engine::Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles};
}
inline voile::MeshCollider deforming(const voile::engine::Mesh& mesh)
{
    return {.positions = mesh.positions, .triangles = mesh.triangles, .deforms = true};
}

inline std::vector<glm::vec3> transformed(const std::vector<glm::vec3>& positions, const glm::mat4& transform)
{
    std::vector<glm::vec3> result;
    result.reserve(positions.size());
    for (const glm::vec3& p : positions)
        result.emplace_back(transform * glm::vec4(p, 1));
    return result;
}

// A square sheet of fabric, flat at a height, without air.
inline voile::GridCloth flat_sheet(uint32_t vertices, float size, float height)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = vertices;
    grid.width = grid.depth = size;
    grid.transform = moved({0, height, 0});
    voile::Fabric fabric;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    grid.material = fabric;
    return grid;
}

// The Fabric of a grid that has one.
inline voile::Fabric& fabric_of(voile::GridCloth& grid)
{
    return std::get<voile::Fabric>(grid.material);
}
inline const voile::Fabric& fabric_of(const voile::GridCloth& grid)
{
    return std::get<voile::Fabric>(grid.material);
}

// The error message of a refused call.
template <typename Result>
std::string reason(const Result& result)
{
    return result ? std::string("accepted") : result.error().message;
}

} // namespace tests
