// Statistics: what is counted on the GPU, once a frame, over all cloths.
#pragma once

#include <cstdint>

namespace voile
{

// A vertex is inside a sphere, a capsule, a box or the half space below a plane, or inside a mesh with one side (a
// closed one pushes outwards unless it is told otherwise) where its generalized winding number is above 1/2 (Jacobson
// et al. 2013). A mesh with two sides has no inside: an open one, unless it is told otherwise, may be a bowl that holds
// cloth. Depth is the distance to the nearest surface; of a mesh that cuts itself, or whose parts lie in each other,
// that may be a surface within the solid.
//
// A closed mesh costs one line through its hierarchy for each vertex in its box, and a search for the nearest triangle
// for each one inside. An open mesh with one side costs a look at every triangle for each vertex in its box.
struct Statistics
{
    float max_stretch = 0;             // max of l / L - 1 over the structural and shear springs, or a mesh's edges
    float mean_stretch = 0;            // mean of the same
    float kinetic_energy = 0;          // J
    float deepest_penetration = 0;     // m, of the vertex that is deepest inside a collider; 0 if none is inside one
    uint32_t penetrating_vertices = 0; // vertices inside a collider
    uint32_t nan_vertices = 0;         // vertices whose position or velocity is not finite
    uint32_t contacts = 0;             // vertices that touched a collider in the last substep
    uint32_t candidates = 0;           // triangles of colliders in the lists that vertices keep
    uint32_t overflowing_vertices = 0; // vertices near more triangles than a list holds. They traverse the hierarchy in
                                       // every substep: slower, and nothing is left out
};

} // namespace voile
