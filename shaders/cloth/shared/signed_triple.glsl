// Three signed numbers of 9 bits in the lower 27 bits of a word.
#ifndef VOILE_SIGNED_TRIPLE_GLSL
#define VOILE_SIGNED_TRIPLE_GLSL

const int k_triple_bits = 9;                                          // of each
const float k_most_of_triple = float((1 << (k_triple_bits - 1)) - 1); // of their magnitudes

// Rounds and clamps.
uint pack_triple(vec3 numbers)
{
    const ivec3 words = ivec3(clamp(roundEven(numbers), -k_most_of_triple, k_most_of_triple));
    uint result = 0;
    for (uint k = 0; k < 3; ++k)
        result |= (uint(words[k]) & ((1u << k_triple_bits) - 1)) << (k * k_triple_bits);
    return result;
}

vec3 unpack_triple(uint word)
{
    return vec3(bitfieldExtract(int(word), 0, k_triple_bits), bitfieldExtract(int(word), k_triple_bits, k_triple_bits),
                bitfieldExtract(int(word), 2 * k_triple_bits, k_triple_bits));
}

// The exponent of 2 of the unit in which the largest of three numbers fits.
int triple_exponent(vec3 numbers)
{
    int exponent;
    frexp(max(max(abs(numbers.x), abs(numbers.y)), abs(numbers.z)), exponent);
    return exponent - (k_triple_bits - 1);
}

#endif
