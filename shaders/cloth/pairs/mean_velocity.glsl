// How fast the vertices of an island that are clear of colliders move on average (pair_clear.comp).
//
// The including kernel declares pair_islands[] and push.
#ifndef VOILE_MEAN_VELOCITY_GLSL
#define VOILE_MEAN_VELOCITY_GLSL

#include "pairs/island.glsl"
#include "shared/step_input.glsl"

// m/s, at a pass, of a vertex that falls freely.
vec3 velocity_at_pass(vec3 velocity, uint cloth_flags)
{
    precise const vec3 lag = seconds(push.lag) * step_input.gravity;
    return velocity + ((cloth_flags & VOILE_CLOTH_VERLET) != 0 ? lag : vec3(0));
}

// m/s: of a sum of velocities.
vec3 mean_of(ivec3 sum, uint count)
{
    return vec3(sum) * (VOILE_PAIR_UNIT_SPEED * float(push.places) / float(max(count, 1)));
}

ivec3 velocities_of(uint island)
{
    return ivec3(pair_islands[island].velocity[0], pair_islands[island].velocity[1], pair_islands[island].velocity[2]);
}

// m/s
vec3 mean_velocity(uint island) { return mean_of(velocities_of(island), pair_islands[island].clear); }

#endif
