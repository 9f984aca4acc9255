// Pairs of near primitives of cloths, as the GPU reads and writes them: a vertex and a triangle, or two edges.
#ifndef VOILE_PAIR_LAYOUT_H
#define VOILE_PAIR_LAYOUT_H

#include "../../shared_types.h"

// The capacity of a vertex's list of pairs.
#define VOILE_PAIRS 32
// The bits of a vertex's index in a pair. The bits above contain the kind and the thickness (pair.glsl).
#define VOILE_PAIR_INDEX_BITS 27

// The most dispatches that make the lists: boxes of leaves, folds of levels, the search.
#define VOILE_PAIR_DISPATCHES 8

VOILE_SHARED_BEGIN(voile)

// Where a vertex may be until the lists are made again: within `reach` of the segment from `from` to `from + sweep`.
// Then no two primitives that no list contains can meet.
struct PairSweep
{
    vec3 from;      // m
    float reach;    // m
    vec3 sweep;     // m
    uint padding_0;
    uvec2 residual; // of `from` (fine_position.glsl)
    uvec2 padding_1;
};

// Where a vertex may be until the next pass over the pairs. Its displacement d from `from` satisfies
// dot(plane.xyz, d) + plane.w >= 0 for each plane, and length(d) <= reach. Then no two primitives of a list can meet.
struct PairGuard
{
    vec4 planes[2];
    vec3 from;      // m
    float reach;    // m
    uvec2 residual; // of `from`
    uvec2 padding;
};

// What a vertex keeps from pass to pass.
struct PairMemory
{
    vec3 velocity; // m/s, after the last pass
    uint pass;     // its number; if it is not the last one, the rest is void
    vec3 slip;     // m, how far the pairs that stick have drifted
    uint padding_1;
};

// A vertex in a pass, as the pairs around it see it.
struct PairMotion
{
    vec3 velocity; // m/s, predicted for the middle of the interval
    float load;    // the sum of its weights in the pairs that are pushed apart
    vec3 slip;     // m, as in PairMemory
    uint friction; // static and kinetic coefficients of the cloth, as halfs
};

// The size of an indirect dispatch. Vertices that ask for new lists write `wanted`.
struct PairDispatch
{
    uint groups;
    uint wanted; // 1 or 0, along y
    uint one;
    uint padding;
};

struct PairPush
{
    float interval;      // s, from this pass to the next
    float sweep_time;    // s, for which the sweeps of the lists last
    float longest_sweep; // m
    uint first_patch;
    uint slots; // of the hierarchy
    uint pass;  // counted over all steps
};

#ifdef __cplusplus
static_assert(sizeof(PairSweep) == 48);
static_assert(sizeof(PairGuard) == 64);
static_assert(sizeof(PairMemory) == 32);
static_assert(sizeof(PairMotion) == 32);
#endif

VOILE_SHARED_END

#endif
