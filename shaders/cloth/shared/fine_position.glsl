// Positions finer than float: what rounding takes from a coordinate is kept beside it.
//
// A float of 1 m is known to 6e-8 m. A stiff spring feels that much more than a vertex feels its weight. So each position has a
// residual, at most half the distance to the next float at the size of its largest coordinate, in three signed 16 bit
// fractions of it: 40 bits together. Springs see differences of both; everything else may read the float alone.
// Source of the sums: Knuth 1969, "The Art of Computer Programming", volume 2, 4.2.2 (two-sum).
#ifndef VOILE_FINE_POSITION_GLSL
#define VOILE_FINE_POSITION_GLSL

#include "shared/residual.h"

struct FinePosition
{
    vec3 x;        // m
    vec3 residual; // m; the position is x + residual
};

// Steps are powers of two, and what is packed is a step's exponent and three fractions with an offset: what takes them apart
// are bit operations and sums, no conversions, which take four times as long.
const float k_residual_offset = 8421376; // 2^23 + 2^15: the float whose low 16 bits are the fraction 0

vec3 unpack_residual(uvec2 bits)
{
    const uvec3 fraction = uvec3(bits.x & 0xffffu, bits.x >> 16, bits.y & 0xffffu);
    return uintBitsToFloat(bits.y & 0xffff0000u) * (uintBitsToFloat(0x4b000000u | fraction) - k_residual_offset);
}

uvec2 pack_residual(FinePosition p)
{
    const uint unit = residual_unit(p.x);
    const float a_unit = uintBitsToFloat((254u << 23) - unit); // 1 / unit, a power of two as well
    const uvec3 fraction = floatBitsToUint(min(p.residual * a_unit, 32767) + k_residual_offset) & 0xffffu;
    return pack_fraction(fraction, unit);
}

// The position moved by a displacement, m.
FinePosition moved(FinePosition p, vec3 displacement)
{
    precise const vec3 shift = p.residual + displacement;
    precise const vec3 x = p.x + shift;
    precise const vec3 added = x - p.x;
    precise const vec3 residual = (p.x - (x - added)) + (shift - added);
    return FinePosition(x, residual);
}

// The displacement from a to b, m.
vec3 displacement(FinePosition a, FinePosition b)
{
    return (b.x - a.x) + (b.residual - a.residual);
}

#endif
