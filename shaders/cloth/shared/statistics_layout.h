// Statistics, as the GPU writes them.
#ifndef VOILE_STATISTICS_LAYOUT_H
#define VOILE_STATISTICS_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// Push constants of the statistics passes.
struct StatisticsPush
{
    uint colliders;
    uint near_stride;
};

struct StatisticsReducePush
{
    uint patches;
    uint slot; // of the result
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
    uint overflowing_vertices; // vertices near more triangles than a list can contain; they traverse in every substep
    uint padding_0;
    uint padding_1;
};

#ifdef __cplusplus
static_assert(sizeof(StatisticsRecord) == 48);
#endif

VOILE_SHARED_END

#endif
