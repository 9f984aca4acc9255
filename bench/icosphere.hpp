// Spheres of 20 * 4^n triangles, and the number of nodes that a query of their hierarchy visits.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <span>

namespace bench
{

// An icosahedron whose triangles are split in four `subdivisions` times, every vertex on the sphere.
voile::engine::Mesh make_icosphere(const glm::vec3& center, float radius, uint32_t subdivisions);

// The nodes of the mesh's hierarchy that the query of a vertex at rest visits: a box of `radius` (m) to every side. The
// mean over all positions (w unused).
double node_visits(const voile::engine::Mesh& mesh, std::span<const glm::vec4> positions, float radius);

} // namespace bench
