// The strain limit and the guard of its energy, as the GPU reads and writes them.
#ifndef VOILE_STRAIN_LAYOUT_H
#define VOILE_STRAIN_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// The most vertices of a level that limit_coarse.comp takes: 17 x 17. Each has 52 bytes of shared memory.
#define VOILE_LIMIT_COARSE_VERTICES 289

// The passes on each level, for a material's limit and for that of softened cloth.
#define VOILE_STRAIN_PASSES 16
#define VOILE_SOFTENED_STRAIN_PASSES 5
// The spectral radius of the iteration, for its acceleration.
#define VOILE_STRAIN_RADIUS 0.95f

// The acceleration of pass i of a level from that of the pass before; 1 for the first. Golub and Varga 1961, after Wang
// 2015, "A Chebyshev semi-iterative approach for accelerating projective and position-based dynamics".
VOILE_INLINE float strain_acceleration(uint i, float before)
{
    const float squared = VOILE_STRAIN_RADIUS * VOILE_STRAIN_RADIUS;
    return i < 2 ? 1 : i == 2 ? 2 / (2 - squared) : 4 / (4 - squared * before);
}

// A vertex of a cloth whose levels are listed (limit_levels.cpp): the first of its entries in LimitLevel[], one for
// each level from 0 to `top`. On the next level its parents stand for it.
//
// After the vertices of a cloth come entries for those on the levels that limit_coarse.comp takes, the widest level
// first: VOILE_LIMIT_COARSE_VERTICES, or as many as the cloth has vertices. Where fewer are on these levels, `top` is
// 0.
struct LimitVertex
{
    uint first_level;
    uint top;
    uint first_parent;
    uint parents;
    uint other; // of a vertex on these levels: the number of its entry; of an entry: its vertex, counted within the
                // cloth
};

// A vertex on a level.
struct LimitLevel
{
    uint first_link;
    uint links;
    float inverse_mass; // of all that moves with it, relative to others of the cloth
    uint padding;
};

struct LimitLink
{
    uint neighbor;      // counted within the cloth
    float rest_length;  // m, along the cloth
    float shear;        // 0 along warp and weft, 1 halfway between
    float inverse_mass; // of the neighbor on this level
};

struct LimitParent
{
    uint vertex; // counted within the cloth
    float weight;
};

// Push constants of one pass of the strain limit.
struct StrainPush
{
    uint spacing;       // of the level, in grid lines: 1 << level
    uint between;       // 1: vertices between the lines of the level before take their neighbors' mean displacement
    float acceleration; // of the passes of a level (Chebyshev); 1: none
    uint pass;          // on its level; in the first one vertices have no relaxation from a pass before
    uint last;          // 1: the last of all passes; it writes the flags of vertices in place of their relaxation
};

// The energy and work of a change of state, by a step or by the strain limit, summed over a patch (limit_work.comp). dx
// is the displacement of a vertex, dv its change of velocity.
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

// The fractions of the strain limit's changes that a cloth keeps, and the energy that the limit has removed and may
// return.
struct LimitScale
{
    float position;   // 0..1, of the current displacements
    float velocity;   // 0..1, of the changes of velocity
    float shift_rate; // 1/s; displacements times this are added to the velocities
    float fraction;   // 0..1, of the limit's original displacements
    float reserve; // J, that displacements may cost; after the last measurement, that those of the next step may cost
    float dissipated; // J, by this step; displacements may cost it in addition
};

// The number of measurements of the energy of the displacements that are kept.
#define VOILE_LIMIT_MEASUREMENTS 2

struct LimitScalePush
{
    uint patches;
    uint measurement; // 0: of all displacements; 1 .. VOILE_LIMIT_MEASUREMENTS: of those that are kept
};

#ifdef __cplusplus
static_assert(sizeof(LimitVertex) == 20);
static_assert(sizeof(LimitLevel) == 16);
static_assert(sizeof(LimitLink) == 16);
static_assert(sizeof(LimitParent) == 8);
static_assert(sizeof(LimitWork) == 36);
static_assert(sizeof(LimitScale) == 24);
#endif

VOILE_SHARED_END

#endif
