// Sweeps and carries: how the lists of pairs expect vertices to move. The clock of the lists carries all vertices
// together; from there a vertex may be anywhere on its sweep. The middle of both is the midpoint. Half of each is
// packed: three signed numbers of 9 bits and an exponent of 4. They are what the packed words say. The last bit of a carry
// says that gravity accelerates it, too.
#ifndef VOILE_SWEEP_GLSL
#define VOILE_SWEEP_GLSL

#include "shared/step_input.glsl"

const uint k_sweep_bits = 9;
const uint k_exponent_bits = 4;
const int k_lowest_exponent = -22; // of the unit of the numbers, in m; the highest is -7
const uint k_falls_bit = 1u << 31;

uint pack_half_sweep(vec3 sweep)
{
    const float largest = max(max(abs(sweep.x), abs(sweep.y)), abs(sweep.z));
    int exponent;
    frexp(largest, exponent);
    exponent = clamp(exponent - int(k_sweep_bits - 1), k_lowest_exponent,
                     k_lowest_exponent + (1 << k_exponent_bits) - 1);
    if (largest == 0)
        exponent = k_lowest_exponent;
    const float most = float((1 << (k_sweep_bits - 1)) - 1);
    const ivec3 words = ivec3(clamp(roundEven(ldexp(sweep, ivec3(-exponent))), -most, most));
    uint result = uint(exponent - k_lowest_exponent) << (3 * k_sweep_bits);
    for (uint k = 0; k < 3; ++k)
        result |= (uint(words[k]) & ((1u << k_sweep_bits) - 1)) << (k * k_sweep_bits);
    return result;
}

vec3 unpack_half_sweep(uint word)
{
    const uint exponent =
        bitfieldExtract(word, int(3 * k_sweep_bits), int(k_exponent_bits)) + uint(127 + k_lowest_exponent);
    const ivec3 words = ivec3(bitfieldExtract(int(word), 0, int(k_sweep_bits)),
                              bitfieldExtract(int(word), int(k_sweep_bits), int(k_sweep_bits)),
                              bitfieldExtract(int(word), int(2 * k_sweep_bits), int(k_sweep_bits)));
    return uintBitsToFloat(exponent << 23) * vec3(words);
}

// Half of what a vertex of this velocity, m/s, goes while lists last.
uint pack_carry(vec3 velocity) { return pack_half_sweep(0.5 * step_input.list_time * velocity); }

// m/s
vec3 carry_velocity(uint word) { return 2 / step_input.list_time * unpack_half_sweep(word); }

// 1 or 0: whether gravity accelerates what is carried so.
float falls(uint word) { return float(word >> 31); }

// m, of the packed numbers
float sweep_unit(uint word)
{
    return ldexp(1.0, int(bitfieldExtract(word, int(3 * k_sweep_bits), int(k_exponent_bits))) + k_lowest_exponent);
}

#endif
