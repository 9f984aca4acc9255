// What carries freely falling cloth beyond what its packed word says: gravity, and what packing rounded off.
//
// The including kernel declares pair_islands[].
#ifndef VOILE_PAIR_FALL_GLSL
#define VOILE_PAIR_FALL_GLSL

#include "shared/step_input.glsl"

vec3 rounded_off(uint cloth) // m/s
{
    return vec3(pair_islands[cloth].rounded_off[0], pair_islands[cloth].rounded_off[1],
                pair_islands[cloth].rounded_off[2]);
}

#endif
