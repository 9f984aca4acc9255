// Statistics, as the GPU writes them.
#ifndef VOILE_STATISTICS_LAYOUT_H
#define VOILE_STATISTICS_LAYOUT_H

#include "../../shared_types.h"

// Bits of a vertex in the buffer of intersections.
#define VOILE_INTERSECTS_CLOTH 1u
#define VOILE_INTERSECTS_COLLIDER 2u

VOILE_SHARED_BEGIN(voile)

// Push constants of the statistics passes.
struct StatisticsPush
{
    uint colliders;
    uint near_stride;
    uint features; // 1: the last step found the features near cloth
};

// Push constants of the passes that count intersections. Row y of the workgroups works on tree first_tree + y.
struct IntersectionPush
{
    uint trees; // in the table
    uint first_tree;
    uint levels; // of the trees of the dispatch
    uint colliders;
};

struct StatisticsReducePush
{
    uint patches;
    uint slot;      // of the result
    uint pairs_met; // 0: the last step had no passes over pairs
};

// Pairs of an edge and a triangle, or of a triangle and a solid, that intersect.
struct IntersectionCounters
{
    uint cloth_pairs;     // cloth and cloth
    uint collider_pairs;  // cloth and collider
    uint uncertain_pairs; // of both, those that may not intersect
    uint counted;         // 0 in a result without them
};

// Sums and maxima over a patch, and, reduced, over all cloths.
struct StatisticsRecord
{
    float max_stretch;         // max of l / L - 1 over structural and shear springs
    float stretch_sum;         // sum of l / L - 1 over the same springs
    float kinetic_energy;      // J
    float deepest_penetration; // m, of a vertex inside a collider from the nearest surface
    uint springs;              // the number of springs in stretch_sum
    uint nan_vertices;         // vertices with a position or velocity that is not finite
    uint penetrating_vertices; // vertices inside a collider
    uint contacts;             // vertices that touch a collider
    uint candidates;           // triangles in the lists of all vertices
    uint overflowing_vertices; // near more triangles or features than a list holds; they traverse in every substep
    uint forced_pairs;         // in which vertices without mass took more room than there was, in the last step
    uint tangled_pairs;        // of cloths that collide with themselves, that intersected when the last step started
    uint pair_searches;        // of the last step, for near pairs of cloths that collide with themselves
    uint sleeping_cloths;      // counted at their first vertices
};

// What the host reads.
struct StatisticsResult
{
    StatisticsRecord cloths;
    IntersectionCounters intersections;
};

#ifdef __cplusplus
static_assert(sizeof(StatisticsRecord) == 56);
static_assert(sizeof(StatisticsResult) == 72);
#endif

VOILE_SHARED_END

#endif
