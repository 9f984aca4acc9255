// The input of a step, push constants of the integrators, and edits of a cloth between steps.
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

// The forces of a mesh's vertex are summed up in so many parts where threads may take one each.
#define VOILE_FORCE_PARTS 4
// Of shared memory, per vertex of a workgroup whose threads share forces, at most (mesh_forces.glsl).
#define VOILE_SHARED_FORCE_BYTES 128

VOILE_SHARED_BEGIN(voile)

// What may differ between two steps with the same passes. Passes read it from a uniform buffer, so that their commands
// can be used again (StepCommands). Push constants count time in substeps of level 0.
struct StepInput
{
    vec3 gravity;         // m/s^2
    float substep;        // s, of level 0
    vec3 wind;            // m/s
    float air_density;    // kg/m^3
    vec4 gust_phases;     // turns, of the four waves of the gusts at the step's start
    vec4 gust_rates;      // turns/s, of these phases
    float gust_speed;     // m/s, root mean square of the sum of all waves
    float gust_frequency; // 1/m, of the longest wave
    float rate;           // 1/s, of the step's progress
    float sudden;         // m/s, the speed that a vertex at rest may gain until the next query
    uint first_substep;   // counted over all steps
    uint first_pair_pass; // counted over all steps
    float list_time;      // s: how long lists of pairs last that are made in the step
    float pair_fall;      // m: how far gravity alone may carry a vertex meanwhile
    uint driven;          // 1: colliders or anchors may move
    uint edited;          // 1: the host has changed more than that since the last step
};

// Push constants of the integration passes. Times are in substeps of level 0.
struct StagePush
{
    float substeps;   // of the whole substep
    float time;       // since the step's start
    float kick;       // Verlet: the time for which the acceleration acts on the velocity
    float drift;      // Verlet: the time for which the position moves; 0 at the end of a step
    uint stage;       // RK4: 1 to 4
    uint first_patch; // of the dispatch
    uint planes;      // Verlet: 1: vertices stay above the planes of the last contact pass
    uint gusts;       // 1: the step has gusts. Known before StepInput has arrived, so the gather need not wait for it
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
static_assert(sizeof(StepInput) == 104);
static_assert(offsetof(StepInput, gust_phases) == 32 && offsetof(StepInput, gust_speed) == 64);
static_assert(offsetof(EditPush, velocity) == 64);
#endif

VOILE_SHARED_END

#endif
