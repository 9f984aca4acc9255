// Positions finer than float: a residual keeps the rounding error of each coordinate.
//
// A float at 1 m has a resolution of 6e-8 m. In a stiff spring that is a larger force than the weight of a vertex. A
// residual is at most half the distance from the largest coordinate to the next float, in three signed fractions of 16
// bits: coordinates have 40 bits together. Springs use differences of both. Everything else may read the float alone.
// Source of the sums: Knuth 1969, "The Art of Computer Programming", volume 2, 4.2.2 (two-sum).
#ifndef VOILE_FINE_POSITION_GLSL
#define VOILE_FINE_POSITION_GLSL

#include "shared/residual.h"

struct FinePosition
{
    vec3 x;        // m
    vec3 residual; // m; the position is x + residual
};

// The 64 bits hold the unit's exponent and three fractions with an offset (residual.h). Bit operations and sums pack
// and unpack them, because conversions take four times as long.
const float k_residual_offset = 8421376; // 2^23 + 2^15: the float whose low 16 bits are 32768, the fraction 0

vec3 unpack_residual(uvec2 bits)
{
    const uvec3 fraction = uvec3(bits.x & 0xffffu, bits.x >> 16, bits.y & 0xffffu);
    return uintBitsToFloat(bits.y & 0xffff0000u) * (uintBitsToFloat(0x4b000000u | fraction) - k_residual_offset);
}

uvec2 pack_residual(FinePosition p)
{
    const uint unit = residual_unit(p.x);
    const float per_unit = uintBitsToFloat((254u << 23) - unit); // 1 / unit, a power of two as well
    const uvec3 fraction = floatBitsToUint(min(p.residual * per_unit, 32767) + k_residual_offset) & 0xffffu;
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
