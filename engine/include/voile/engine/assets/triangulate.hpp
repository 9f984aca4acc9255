// Polygons to triangles.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace voile::engine
{

// Cuts a polygon of n >= 3 corners, in order around it, into n - 2 triangles of the same winding that use its corners
// alone. Concave polygons work, and so do nearly flat ones: the polygon is looked at along its mean normal (Newell). Of
// all ears the one with the shortest cut goes first (Meisters 1975), which splits a convex quad along its shorter
// diagonal. A polygon that crosses itself still gives n - 2 triangles, some of them turned over.
std::vector<glm::uvec3> triangulate(std::span<const glm::vec3> corners);

} // namespace voile::engine
