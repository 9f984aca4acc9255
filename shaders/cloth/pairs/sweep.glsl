// Sweeps and carries: how the lists of pairs expect vertices to move. The clock of the lists carries all vertices
// together; from there a vertex may be anywhere on its sweep. The middle of both is the midpoint. Half of each is
// packed: three signed numbers of 9 bits and an exponent of 4. They are what the packed words say. The last bit of a carry
// says that gravity accelerates it, too.
#ifndef VOILE_SWEEP_GLSL
#define VOILE_SWEEP_GLSL

#include "shared/signed_triple.glsl"

const uint k_exponent_bits = 4;
const int k_lowest_exponent = -22; // of the unit of the numbers, in m; the highest is -7
const uint k_falls_bit = 1u << 31;

uint pack_half_sweep(vec3 sweep)
{
    int exponent = clamp(triple_exponent(sweep), k_lowest_exponent, k_lowest_exponent + (1 << k_exponent_bits) - 1);
    if (sweep == vec3(0))
        exponent = k_lowest_exponent;
    return pack_triple(ldexp(sweep, ivec3(-exponent))) | uint(exponent - k_lowest_exponent) << (3 * k_triple_bits);
}

vec3 unpack_half_sweep(uint word)
{
    const uint exponent =
        bitfieldExtract(word, 3 * k_triple_bits, int(k_exponent_bits)) + uint(127 + k_lowest_exponent);
    return uintBitsToFloat(exponent << 23) * unpack_triple(word);
}

// 1 or 0: whether gravity accelerates what is carried so.
float falls(uint word) { return float(word >> 31); }

// m, of the packed numbers
float sweep_unit(uint word)
{
    return ldexp(1.0, int(bitfieldExtract(word, 3 * k_triple_bits, int(k_exponent_bits))) + k_lowest_exponent);
}

#endif
