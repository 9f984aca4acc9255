// Vertex normals from the triangles around each vertex.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace voile::engine
{

// Sets one sum a position, not of unit length. Each triangle's normal counts by its angle at the corner, so that the
// result does not depend on how a flat face is cut (Thürmer and Wüthrich 1998, "Computing vertex normals from polygonal
// facets"). Triangles without area count nothing. Indices must be within `positions`. Allocates where `sums` grows.
void sum_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 std::vector<glm::dvec3>& sums);

// Of unit length. Where the triangles cancel out any direction is as good.
glm::vec3 unit_normal(const glm::dvec3& sum);

} // namespace voile::engine
