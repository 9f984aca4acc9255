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
vec3 mean_of(ivec3 momentum, uint mass)
{
    return vec3(momentum) * (VOILE_PAIR_UNIT_SPEED / VOILE_PAIR_UNIT_MASS / float(max(mass, 1)));
}

ivec3 momentum_of(uint island)
{
    return ivec3(pair_islands[island].momentum[0], pair_islands[island].momentum[1], pair_islands[island].momentum[2]);
}

// m, of those vertices, from the origin of the frame.
vec3 mean_position(uint island)
{
    const ivec3 moment =
        ivec3(pair_islands[island].moment[0], pair_islands[island].moment[1], pair_islands[island].moment[2]);
    return mean_of(moment, pair_islands[island].mass);
}

// m/s, in the frame of the island.
vec3 mean_velocity(uint island)
{
    return mean_of(momentum_of(island), pair_islands[island].mass) - velocity_at(frame_of(island), mean_position(island));
}

#endif
