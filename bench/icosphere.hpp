// Spheres of 20 * 4^n triangles, and what a query of their hierarchy visits.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <span>

namespace bench
{

// An icosahedron whose triangles are cut in four `subdivisions` times, every vertex on the sphere.
voile::engine::Mesh make_icosphere(const glm::vec3& center, float radius, uint32_t subdivisions);

// Nodes of the mesh's hierarchy whose boxes are looked at by the query of a vertex that rests: the box of `reach` (m)
// to every side. The mean over all positions (w unused).
double node_visits(const voile::engine::Mesh& mesh, std::span<const glm::vec4> positions, float reach);

} // namespace bench
