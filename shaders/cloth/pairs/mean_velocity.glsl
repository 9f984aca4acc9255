// How fast vertices that are clear of colliders move on average (pair_clear.comp).
//
// The including kernel declares pair_passes[] and push.
#ifndef VOILE_MEAN_VELOCITY_GLSL
#define VOILE_MEAN_VELOCITY_GLSL

#include "shared/step_input.glsl"

// m/s, at a pass, of a vertex that falls freely.
vec3 velocity_at_pass(vec3 velocity, uint cloth_flags)
{
    precise const vec3 lag = seconds(push.lag) * step_input.gravity;
    return velocity + ((cloth_flags & VOILE_CLOTH_VERLET) != 0 ? lag : vec3(0));
}

// m/s: the mean of all vertices that are clear of colliders.
vec3 mean_velocity()
{
    const PairDispatch sum = pair_passes[VOILE_PAIR_CLEAR];
    return vec3(int(sum.groups), int(sum.wanted), int(sum.one)) *
           (VOILE_PAIR_UNIT_SPEED * float(push.places) / float(max(sum.entries, 1)));
}

#endif
