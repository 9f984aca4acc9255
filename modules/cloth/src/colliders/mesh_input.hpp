// Meshes as they are given: validation, placement, welding, orientation.
#pragma once

#include "voile/descriptions.hpp"

#include <span>
#include <vector>

namespace voile
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

} // namespace voile
