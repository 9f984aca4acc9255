// Meshes as they are given: validation, placement, welding, orientation.
#pragma once

#include "cloth/descriptions.hpp"

#include <span>
#include <vector>

namespace cloth
{

// A collider's mesh in world space, without triangles that have no area; closed ones face outwards.
struct MeshInput
{
    std::vector<glm::vec3> positions; // m
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
// place count as one; no triangle may have two corners there. `volume` (m^3) is what a closed mesh encloses, negative
// for an inside-out one; 0 for an open one.
struct Closedness
{
    bool closed = false;
    double volume = 0;
};
Closedness closedness(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles);

} // namespace cloth
