// Triangulates polygons.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace voile::engine
{

// Cuts a polygon of n >= 3 corners, in order around it, into n - 2 triangles of the same winding. Adds no vertices.
// Concave and nearly flat polygons work: the polygon is projected along its mean normal (Newell). Ear clipping
// (Meisters 1975) takes the ear with the shortest cut first, which splits a convex quad along its shorter diagonal. A
// polygon that crosses itself still gives n - 2 triangles, some of them flipped.
std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners);

} // namespace voile::engine
