// The strain limit and the guard of its energy, as the GPU reads and writes them.
#ifndef VOILE_STRAIN_LAYOUT_H
#define VOILE_STRAIN_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// Push constants of one pass of the strain limit.
struct StrainPush
{
    uint spacing; // of the level, in grid lines
    uint between; // 1: vertices between the lines of the level before take over what their neighbors were moved by
    float acceleration; // of the passes of a level (Chebyshev); 1: none
    uint first;         // 1: of a level; no vertex knows yet what it bears
    uint last;          // 1: of all; what vertices bear gives way to their flags
};

// A patch's part of what a step or the strain limit does to its cloth (limit_work.comp). Of a displacement dx and a
// change of velocity dv:
struct LimitWork
{
    float energy;      // J, of springs in one state
    float work;        // J, of elastic forces and gravity in that state along dx
    float linear_work; // J, of bending and gravity alone
    float v_dv;        // J, sum of m v . dv
    float dv_dv;       // J, sum of m dv . dv
    float v_dx;        // J s, sum of m v . dx
    float dx_dx;       // J s^2, sum of m dx . dx
    float dv_dx;       // J s, sum of m dv . dx
    float undone;      // J s^2, minus the sum of m dx . (displacement from the step's start)
};

// How much a cloth takes of what the strain limit changes, and what the limit has taken from its energy and may give
// back.
struct LimitScale
{
    float position;   // 0..1, of the displacements as they are now
    float velocity;   // 0..1, of the changes of velocity
    float shift_rate; // 1/s, of the displacements as a change of velocity besides
    float kept;       // 0..1, of the limit's displacements in all
    float saved;      // J, that displacements may cost; after the last look, what the next step may
    float lost;       // J, that they may cost besides, gone in this step
};

// How often the energy of what is kept is measured.
#define VOILE_LIMIT_MEASUREMENTS 2

struct LimitScalePush
{
    uint patches;
    float rate; // 1/s, the largest shift_rate
    uint measurement;  // 0: at all of the displacements; then, up to VOILE_LIMIT_MEASUREMENTS, at what is kept of them
};

#ifdef __cplusplus
static_assert(sizeof(LimitWork) == 36);
static_assert(sizeof(LimitScale) == 24);
#endif

VOILE_SHARED_END

#endif
