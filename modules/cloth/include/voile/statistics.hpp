// Statistics of all enabled cloths, computed on the GPU by Solver::record_statistics.
#pragma once

#include <cstdint>
#include <optional>

namespace voile
{

// Intersecting pairs, counted exactly for the positions in the vertex streams, which are floats.
//
// A pair is an edge and a triangle that have a point in common: they cross, touch, or overlap in a plane. Each edge of
// a mesh or a grid counts once, including diagonals (Solver::triangles). Signs of orientation determinants are exact (a
// filter in float, then integers), so the numbers depend on no tolerance, and two runs are equal. Triangles with a
// corner that is not finite are left out.
//
// - Cloth: edges and triangles of one cloth, and of two cloths that share a layer. Pairs with a common vertex are left
//   out: unless they lie in one plane, they touch only at that vertex. So two neighboring triangles that are folded
//   flat onto each other count only by edges without a common vertex.
// - Meshes and boxes: edges of the cloth through triangles of the collider and edges of the collider through triangles
//   of the cloth, for colliders that share a layer, at the end of the last step. Vertices of rigid meshes at one
//   position are one; edges of deforming meshes are pairs of its vertices, so a seam counts on both sides. A face of a
//   box is two triangles. Vertices of colliders are rounded to float in the world. Cloth that lies in a solid without
//   crossing its surface is counted by penetrating_vertices alone.
// - Spheres, capsules, half spaces: triangles of the cloth that have a point in common with the solid.
//
// Uncertain pairs are also counted: those of a sphere, a capsule or a half space whose distance is 0 to within rounding
// (2e-6 of the distance from the solid's origin, or 1e-5 if the solid was moved). The counts of all others are exact.
// Coordinates are first rounded to multiples of 2^-50 m (9e-16 m). Beyond 2^11 m, a pair is also uncertain if its
// coordinates along one axis differ by more than a factor of 2^39 in size and the filter in float fails.
//
// Cost: a refit of the hierarchies of all cloths, and for each triangle of a cloth a traversal of the hierarchies of
// all cloths and colliders. 64 x 64 vertices at rest on a mesh of 22,200 triangles take 146 ms on lavapipe with two
// cores.
struct IntersectionCounts
{
    uint32_t cloth_pairs = 0;     // cloth and cloth
    uint32_t collider_pairs = 0;  // cloth and collider
    uint32_t uncertain_pairs = 0; // pairs of both kinds that may not intersect, and triangles of cloth that may be in
                                  // more pairs: lavapipe 22.3 ends a search early that finds some hundreds
};

// Whether Solver::record_statistics counts intersections.
enum class Intersections
{
    not_counted,
    counted,
};

// A vertex counts as inside a sphere, a capsule, a box or the half space below a plane, and inside a one-sided mesh
// where the generalized winding number is above 1/2 (Jacobson et al. 2013). Closed meshes are one-sided by default. A
// two-sided mesh has no inside. Open meshes, such as a bowl that holds cloth, are two-sided by default. Depth is the
// distance to the nearest surface. If a mesh intersects itself, or its parts lie in each other, that surface may be
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
    uint32_t overflowing_vertices = 0; // vertices near more triangles, or more edges and corners of colliders
                                       // (Tuning::feature_items), than a list holds. They traverse the hierarchy in
                                       // every substep, which is slower but misses nothing
    uint32_t forced_pairs = 0;    // of cloths that collide with themselves: how often in the last step vertices without
                                  // mass, such as pins, left a pair of near primitives too little room, so that it
                                  // may intersect; counted once per pass over the pairs
    uint32_t tangled_pairs = 0;   // of cloths that collide with themselves: pairs of an edge and a triangle that
                                  // intersected when the last step started, as in IntersectionCounts::cloth_pairs,
                                  // except parts of a mesh that touch at the start; the solver pulls them apart.
                                  // Where the host writes vertices itself, it takes up to 8 steps to see all of them.
                                  // Where triangles are in hundreds of pairs, lavapipe 22.3 does not find all
    uint32_t pair_searches = 0;   // of cloths that collide with themselves: how often the last step searched
                                  // for near pairs, at most once per pass over them, and at least once if such
                                  // a cloth is enabled, also if it sleeps (Tuning::waiting_vertices)
    uint32_t sleeping_cloths = 0; // at the end of the last step (GridCloth::sleep_speed)
    std::optional<IntersectionCounts> intersections{}; // none: not counted
};

} // namespace voile
