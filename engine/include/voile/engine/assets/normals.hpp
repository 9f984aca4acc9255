// Vertex normals from the triangles around each vertex.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace voile::engine
{

// Computes one sum per position, not of unit length. A triangle's normal is weighted by its angle at the corner, so
// that the result does not depend on the triangulation of a flat face (Thürmer and Wüthrich 1998, "Computing vertex
// normals from polygonal facets"). Triangles without area are skipped. Indices must be within `positions`. Allocates
// only if `sums` must grow.
void sum_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 std::vector<glm::dvec3>& sums);

// Returns a unit vector. If the sum is zero, the direction is arbitrary.
glm::vec3 unit_normal(const glm::dvec3& sum);

} // namespace voile::engine
