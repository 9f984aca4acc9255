// Even triangles on a closed surface that a sphere can be mapped to.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <functional>

namespace scenes
{

// Takes a point near the surface, or a unit vector before the first step, to the surface.
using Projection = std::function<glm::dvec3(const glm::dvec3&)>;

struct Surface
{
    Projection from_sphere; // a unit vector to a point of the surface, smooth and one to one
    Projection from_space;  // a point near the surface to one on it
};

// 11,264 triangles, wound outwards. A box of 32 x 32 x 28 squares is blown up to a sphere and mapped to the surface.
// Then, in turn, vertices move to the middle of their triangles and edges flip until they are Delaunay's, which makes
// triangles nearly equilateral and of one size (Alliez et al. 2003, "Isotropic surface remeshing"). The two vertices on
// the y axis stay where they are.
voile::engine::Mesh make_even_mesh(const Surface& surface);

} // namespace scenes
