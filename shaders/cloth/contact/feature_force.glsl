// The force that features exert on a vertex between two contact passes, per mass: m/s^2. A word has three signed numbers
// and an exponent of 4 bits, of powers of 4. It is that of a normal float or 0, so that arithmetic with floats keeps it.
#ifndef VOILE_FEATURE_FORCE_GLSL
#define VOILE_FEATURE_FORCE_GLSL

#include "shared/signed_triple.glsl"

const int k_least_force = -4;   // of the least unit, the exponent of 2
const int k_most_exponent = 14; // the least is 1

uint pack_force(vec3 force)
{
    const int exponent = clamp((triple_exponent(force) - k_least_force + 1) / 2 + 1, 1, k_most_exponent);
    const uint numbers = pack_triple(ldexp(force, ivec3(-k_least_force - 2 * (exponent - 1))));
    return numbers == 0 ? 0 : numbers | uint(exponent) << (3 * k_triple_bits);
}

vec3 unpack_force(uint word)
{
    const int exponent = int(word >> (3 * k_triple_bits));
    return exponent == 0 ? vec3(0) : ldexp(1.0, k_least_force + 2 * (exponent - 1)) * unpack_triple(word);
}

#endif
