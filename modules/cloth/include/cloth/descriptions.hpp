// What can be added to a solver: cloths and colliders. Everything is copied and validated when it is added.
#pragma once

#include "cloth/material.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cloth
{

// A rectangular cloth, flat in x and z and centred on the origin before its transform. Vertex index = row * columns +
// column; column c lies at x = (c / (columns - 1) - 1/2) * width, row r likewise in z.
struct Grid
{
    std::string name = "cloth"; // for messages and captures
    uint32_t columns = 64;      // vertices along x, 2..8192
    uint32_t rows = 64;         // vertices along z, 2..8192
    float width = 1;            // m along x, > 0
    float depth = 1;            // m along z, > 0
    glm::mat4 transform{1.f};   // world from grid; affine. Rest lengths are the grid's, not the transformed ones
    glm::vec3 velocity{0.f};    // m/s, of every vertex at the start
    Material material{};
    std::vector<uint32_t> held{}; // vertices that never move (inverse mass 0)
};

struct Friction
{
    float static_coefficient = 0;  // >= kinetic_coefficient
    float kinetic_coefficient = 0; // >= 0
};

// Friction of a pair is the geometric mean of the fabric's and the collider's; a collider without takes the fabric's.

// A triangle mesh that does not move. Closed meshes (every edge shared by two triangles that agree on it) push
// outwards; inside-out ones are turned. Open meshes push to the side that a vertex comes from.
struct MeshCollider
{
    std::string name = "mesh";
    std::span<const glm::vec3> positions{};  // m, in the mesh's space
    std::span<const glm::uvec3> triangles{}; // indices into positions; triangles without area are dropped
    glm::mat4 transform{1.f};                // world from mesh; affine
    std::optional<Friction> friction{};
};

// Everything below the plane is solid.
struct PlaneCollider
{
    std::string name = "plane";
    glm::vec3 normal{0, 1, 0}; // unit length
    float offset = 0;          // m; normal . x = offset on the plane
    std::optional<Friction> friction{};
};

struct SphereCollider
{
    std::string name = "sphere";
    glm::vec3 center{0.f}; // m
    float radius = 1;      // m, > 0
    std::optional<Friction> friction{};
};

// Names of what was added; only valid in the solver that gave them.
struct ClothId
{
    uint32_t index = 0;
};
struct ColliderId
{
    uint32_t index = 0;
};

} // namespace cloth
