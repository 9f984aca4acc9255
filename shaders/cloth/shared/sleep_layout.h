// The sleep of cloths, as the GPU reads and writes it.
#ifndef VOILE_SLEEP_LAYOUT_H
#define VOILE_SLEEP_LAYOUT_H

#include "../../shared_types.h"
#include "step_layout.h"

// s: a cloth sleeps once it has been calm for so long.
#define VOILE_SLEEP_TIME 0.5f
// SleepRecord::calm of a cloth that sleeps.
#define VOILE_SLEEPING (2 * VOILE_SLEEP_TIME)

VOILE_SHARED_BEGIN(voile)

struct SleepRecord
{
    float calm;    // s, 0 after it was woken, up to VOILE_SLEEP_TIME: how long no vertex has been faster than the
                   // cloth's sleep_speed; VOILE_SLEEPING while it sleeps
    uint speed;    // m/s, the bits of a float: of the fastest vertex in the step
    uint island;   // the first of the cloths that sleep and wake with it (PairIsland); alone, the cloth itself
    uint restless; // in the record of an island's first cloth. 1: some of its cloths must not sleep
    // The box around the vertices at the end of the step. Ordered numbers (ordered.glsl), the lower corner's inverted.
    uint low[3];
    uint high[3];
    // Of a cloth that collides with others and is awake at the beginning of a step: the box that it may reach in it.
    // The same numbers; 0 at the end of the step.
    uint reach_low[3];
    uint reach_high[3];
};

// Push constants of the passes that put cloths to sleep and wake them.
struct SleepPush
{
    uint patches;
    uint colliders; // 0: none moves
    uint cloths;    // the end of the indices of those that collide with each other; 0: at most one does
};

// Push constants of the pass that finds speeds.
struct SpeedsPush
{
    float pass_substeps; // of level 0, from one pass over pairs to the next
};

// The size of the dispatches over the patches of a batch whose cloths are awake.
struct AwakeDispatch
{
    uint patches;
    uint y;
    uint z;
};

// Push constants of the list of these patches: the first patch of each batch, and the end of the last one.
struct AwakePush
{
    uint first_patch[VOILE_SUBSTEP_BATCHES + 1];
};

#ifdef __cplusplus
static_assert(sizeof(SleepRecord) == 64);
static_assert(sizeof(AwakeDispatch) == 12);
#endif

VOILE_SHARED_END

#endif
