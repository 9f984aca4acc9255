// Statistics of all enabled cloths, computed on the GPU by Solver::record_statistics.
#pragma once

#include <cstdint>

namespace voile
{

// A vertex counts as inside a sphere, a capsule, a box or the half space below a plane, and inside a one-sided mesh
// where the generalized winding number is above 1/2 (Jacobson et al. 2013). Closed meshes are one-sided by default. A
// two-sided mesh has no inside; open meshes are two-sided by default, such as a bowl that holds cloth. Depth is the
// distance to the nearest surface. If a mesh intersects itself, or its parts lie in each other, that may be a surface
// within the solid.
//
// Cost: for a closed mesh, one line through its hierarchy per vertex in its box, and a search for the nearest triangle
// per vertex inside; for an open one-sided mesh, a sum over all of its triangles per vertex in its box.
struct Statistics
{
    float max_stretch = 0;             // largest l / L - 1 of the structural and shear springs, or a mesh's edges
    float mean_stretch = 0;            // mean of the same
    float kinetic_energy = 0;          // J
    float deepest_penetration = 0;     // m, of the deepest vertex inside a collider; 0: none is inside
    uint32_t penetrating_vertices = 0; // vertices inside a collider
    uint32_t nan_vertices = 0;         // vertices whose position or velocity is not finite
    uint32_t contacts = 0;             // vertices that touched a collider in the last substep
    uint32_t candidates = 0;           // triangles in the lists of near triangles of all vertices
    uint32_t overflowing_vertices = 0; // vertices near more triangles than a list holds. They traverse the hierarchy in
                                       // every substep, which is slower but misses nothing
};

} // namespace voile
