// What carries freely falling cloth beyond what its packed word says: gravity, and what packing rounded off.
//
// The including kernel declares pair_searches[].
#ifndef VOILE_PAIR_FALL_GLSL
#define VOILE_PAIR_FALL_GLSL

#include "shared/step_input.glsl"

vec3 rounded_off() // m/s
{
    const PairDispatch record = pair_searches[VOILE_PAIR_ROUNDED_OFF];
    return uintBitsToFloat(uvec3(record.groups, record.one, record.entries));
}

#endif
