// What carries freely falling cloth beyond what its packed word says: gravity, and what packing rounded off.
//
// The including kernel declares pair_searches[].
#ifndef VOILE_PAIR_FALL_GLSL
#define VOILE_PAIR_FALL_GLSL

vec3 numbers_of(PairDispatch record) { return uintBitsToFloat(uvec3(record.groups, record.one, record.entries)); }

vec3 gravity_of_pairs() { return numbers_of(pair_searches[VOILE_PAIR_GRAVITY]); } // m/s^2

vec3 rounded_off() { return numbers_of(pair_searches[VOILE_PAIR_ROUNDED_OFF]); } // m/s

#endif
