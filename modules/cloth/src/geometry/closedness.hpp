// Vertices at the same position as one, and whether a mesh has a border.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// For each position, the index of the first one at the same place.
std::vector<uint32_t> weld(std::span<const glm::vec3> positions);

// Whether every edge is shared by exactly two triangles that run along it in opposite directions. Vertices at the same
// place count as one: `welded` is what weld() says of them. No triangle may have two corners there.
bool is_closed(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles);

} // namespace voile
