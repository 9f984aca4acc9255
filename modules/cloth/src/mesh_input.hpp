// Meshes as they are given: validation, placement, welding, orientation.
#pragma once

#include "cloth/descriptions.hpp"

#include <span>
#include <vector>

namespace cloth
{

// A collider's mesh in the world, seen from `origin`, without triangles that have no area; the parts of a closed one
// are turned outwards (mesh_parts.hpp).
struct MeshInput
{
    glm::vec3 origin{0.f};            // m, in the world: the middle of the mesh, rounded
    std::vector<glm::vec3> positions; // m, from there
    std::vector<glm::uvec3> triangles;
    bool closed = false;
};

// Errors: see Solver::add_collider.
Result<MeshInput> prepare_mesh(const MeshCollider& collider);

// Errors: a position that is not finite, an index beyond the positions; `what` and `name` say whose.
Result<void> validate_triangles(const std::string& what, const std::string& name, std::span<const glm::vec3> positions,
                                std::span<const glm::uvec3> triangles);

// For each position, the index of the first one at the same place.
std::vector<uint32_t> weld(std::span<const glm::vec3> positions);

// Whether every edge is shared by exactly two triangles that run along it in opposite directions. Vertices at the same
// place count as one: `welded` is what weld() says of them. No triangle may have two corners there.
bool is_closed(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles);

} // namespace cloth
