// Push constants of the integrators, and edits of a cloth between steps.
#ifndef VOILE_STEP_LAYOUT_H
#define VOILE_STEP_LAYOUT_H

#include "../../shared_types.h"

// Wave vectors of the gusts (wind.glsl), in units of the longest wave's.
#define VOILE_GUST_WAVES                                                                                               \
    vec3(0.8f, 0, 0.6f), vec3(-1.2091f, 0.9068f, 1.3099f), vec3(2.4368f, 2.4368f, -2.0307f),                           \
        vec3(1.5689f, -4.7068f, 6.2757f)

// Groups of cloths by the length of their substeps: each level's are twice as long as those of the level below.
#define VOILE_SUBSTEP_LEVELS 5
// The cloths of a level have dispatches of their own for each integrator.
#define VOILE_SUBSTEP_BATCHES (2 * VOILE_SUBSTEP_LEVELS)

#define VOILE_EDIT_MASSES 0    // sets inverse masses from areas and density
#define VOILE_EDIT_RESET 1     // sets the state to the start
#define VOILE_EDIT_TRANSFORM 2 // transforms positions by the matrix, velocities by its linear part
#define VOILE_EDIT_VELOCITY 3  // sets all velocities to one value

VOILE_SHARED_BEGIN(voile)

// Push constants of the integration passes.
struct StagePush
{
    vec3 gravity;         // m/s^2
    float step;           // s, of the whole substep
    vec3 wind;            // m/s
    float air_density;    // kg/m^3
    vec4 gust_phases;     // rad, of the four waves of the gusts at the current time
    float gust_speed;     // m/s, root mean square of the sum of all waves
    float gust_frequency; // 1/m, of the longest wave
    float kick;           // Verlet: s, the time for which the acceleration acts on the velocity
    float drift;          // Verlet: s, the time for which the position moves; 0 at the end of a step
    uint stage;           // RK4: 1 to 4
    uint first_patch;     // of the dispatch
    uint planes;          // Verlet: 1: vertices stay above the planes of the last contact pass
};

// Push constants of an edit of one cloth.
struct EditPush
{
    mat4 transform;
    vec3 velocity; // m/s
    uint kind;
    uint cloth;
};

#ifdef __cplusplus
static_assert(sizeof(StagePush) == 76);
static_assert(offsetof(StagePush, gust_phases) == 32);
static_assert(offsetof(EditPush, velocity) == 64);
#endif

VOILE_SHARED_END

#endif
