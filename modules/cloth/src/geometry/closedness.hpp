// Welds vertices at the same position, and checks whether a mesh has a border.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace voile
{

// For each position, the index of the first one that is equal.
std::vector<uint32_t> weld(std::span<const glm::vec3> positions);

// Whether every edge is shared by exactly two triangles that run along it in opposite directions. `welded`: what weld()
// returned. No triangle may have two corners at the same position.
bool is_closed(std::span<const uint32_t> welded, std::span<const glm::uvec3> triangles);

} // namespace voile
