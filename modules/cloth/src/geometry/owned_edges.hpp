// Which triangle of a mesh owns an edge.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// Bit i of a triangle: it owns the edge from its corner i to corner (i + 1) % 3. An edge, two vertices in any order,
// belongs to the first triangle that has it.
std::vector<uint8_t> owned_edges(std::span<const glm::uvec3> triangles);

} // namespace voile
