// How fast the vertices of an island that are clear of colliders move on average, by mass (pair_clear.comp): what guards cut from
// a motion relative to that leaves their momentum as it is, on average.
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

// m/s or m: of sums over vertices.
vec3 mean_of(int sum[3], uint mass)
{
    return vec3(sum[0], sum[1], sum[2]) * (VOILE_PAIR_UNIT_SPEED / VOILE_PAIR_UNIT_MASS / float(max(mass, 1)));
}

// m/s, in the frame of the island.
vec3 mean_velocity(uint island)
{
    const uint mass = pair_islands[island].mass;
    const vec3 position = mean_of(pair_islands[island].moment, mass); // from the origin of the frame
    return mean_of(pair_islands[island].momentum, mass) - velocity_at(frame_of(island).motion, position);
}

#endif
