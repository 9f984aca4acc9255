// Even triangles on a closed surface that a sphere maps to.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <functional>
#include <vector>

namespace scenes
{

// Maps a point near the surface, or a unit vector before the first step, to the surface.
using Projection = std::function<glm::dvec3(const glm::dvec3&)>;

struct Surface
{
    Projection from_sphere; // maps a unit vector to a point of the surface, smooth and one to one
    Projection from_space;  // maps a point near the surface to a point on it
};

// Moves vertices to the center of their triangles and flips edges until they are Delaunay's, in turn, which makes
// triangles nearly equilateral and of one size (Alliez et al. 2003, "Isotropic surface remeshing"). `mesh` must be
// closed; vertices of `is_fixed` do not move.
struct EvenMesh
{
    std::vector<glm::dvec3> points;
    std::vector<glm::uvec3> triangles;
    std::vector<bool> is_fixed; // one per point
};
void even_out(EvenMesh& mesh, const Projection& project, int rounds);

// 11,264 triangles, wound outward. A box of 32 x 32 x 28 squares is projected to a sphere and mapped to the surface.
// Then it is evened out. The two vertices on the y axis do not move.
voile::engine::Mesh make_even_mesh(const Surface& surface);

} // namespace scenes
