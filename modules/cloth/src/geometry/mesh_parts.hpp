// The parts of a closed mesh: which triangles hang together, which part lies in which, and which are inside-out.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// Triangles that hang together by vertices are a part; vertices at the same place count as one.
struct MeshParts
{
    uint32_t count = 0;                 // numbered in the order of their first triangles
    std::vector<uint32_t> of_triangles; // one a triangle; empty where there is one part
};
MeshParts find_parts(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles);

// For each part of a closed mesh of several, those that it lies in: all six of its vertices that reach farthest along
// the axes are inside of them.
std::vector<std::vector<uint32_t>> enclosing_parts(std::span<const glm::vec3> positions,
                                                   std::span<const glm::uvec3> triangles, const MeshParts& parts);

// Turns the parts of a closed mesh that are inside-out. What lies in a part that is turned is turned with it. A part
// that is inside-out in the solid of another is a cavity, and left as it is; in a cavity it is turned.
void face_outwards(std::span<const glm::vec3> positions, std::span<const uint32_t> welded,
                   std::span<glm::uvec3> triangles);

} // namespace voile
