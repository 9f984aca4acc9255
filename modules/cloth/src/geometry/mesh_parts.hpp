// The parts of a closed mesh: which triangles are connected, which part lies in which, and which are inside-out.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// A part is a set of triangles that are connected by vertices. Vertices at the same position count as one.
struct MeshParts
{
    uint32_t count = 0;                 // numbered in the order of their first triangles
    std::vector<uint32_t> of_triangles; // one per triangle; empty if there is one part
};
MeshParts find_parts(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles);

// For each part of a closed mesh, the parts that it lies in: those that contain all six of its farthest vertices along
// the axes.
std::vector<std::vector<uint32_t>> enclosing_parts(std::span<const glm::vec3> positions,
                                                   std::span<const glm::uvec3> triangles, const MeshParts& parts);

// Flips the parts of a closed mesh that are inside-out, each with the parts that lie in it. A part that is inside-out
// within the solid of another one is a cavity and stays as it is; within a cavity it is flipped.
void face_outwards(std::span<const glm::vec3> positions, std::span<const uint32_t> welded,
                   std::span<glm::uvec3> triangles);

} // namespace voile
