// The sleep of cloths, as the GPU reads and writes it.
#ifndef VOILE_SLEEP_LAYOUT_H
#define VOILE_SLEEP_LAYOUT_H

#include "../../shared_types.h"

// s: a cloth sleeps once it has been calm for so long.
#define VOILE_SLEEP_TIME 0.5f

VOILE_SHARED_BEGIN(voile)

// All 0: the cloth is awake and has not been calm yet.
struct SleepRecord
{
    float calm;    // s, up to VOILE_SLEEP_TIME: how long no vertex has been faster than the cloth's sleep_speed
    uint speed;    // m/s, the bits of a float: of the fastest vertex in the step
    uint island;   // the first of the cloths that sleep and wake with it (PairIsland)
    uint restless; // in the record of an island's first cloth. 1: not all of its cloths have been calm for long enough
    // The box around the vertices, once they may sleep. Ordered numbers (ordered.glsl), the lower corner's inverted.
    uint low[3];
    uint high[3];
};

// Push constants of the passes that put cloths to sleep and wake them.
struct SleepPush
{
    uint patches;
    uint colliders; // 0: none moves
    uint islands;   // 1: cloths that collide with each other have islands
};

#ifdef __cplusplus
static_assert(sizeof(SleepRecord) == 40);
#endif

VOILE_SHARED_END

#endif
