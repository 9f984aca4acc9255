// The 64 bits of a residual, the rounding error of a position. See fine_position.glsl.
#ifndef VOILE_RESIDUAL_H
#define VOILE_RESIDUAL_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// The unit of a residual, m, as the bits of a float. It is a power of two: 2^-15 of half the distance from the largest
// coordinate to the next float. Computed by bit operations, because conversions take four times as long.
VOILE_INLINE uint residual_unit(vec3 x)
{
    const float largest = max(max(abs(x.x), abs(x.y)), abs(x.z));
    const uint exponent = floatBitsToUint(largest) & 0x7f800000u;
    return max(exponent, 40u << 23) - (39u << 23);
}

// `fraction`: in units, with an offset of 32768. The low half of `unit` is 0.
VOILE_INLINE uvec2 pack_fraction(uvec3 fraction, uint unit)
{
    return uvec2(fraction.x | fraction.y << 16, fraction.z | unit);
}

VOILE_SHARED_END

#endif
