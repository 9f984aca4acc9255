// Positions finer than float: what rounding takes from a coordinate is kept beside it.
//
// A float of 1 m is known to 6e-8 m. A stiff spring feels that much more than a vertex feels its weight. So each position has a
// residual, at most half the distance to the next float at the size of its largest coordinate, in three signed 16 bit
// fractions of it: 40 bits together. Springs see differences of both; everything else may read the float alone.
// Source of the sums: Knuth 1969, "The Art of Computer Programming", volume 2, 4.2.2 (two-sum).
#ifndef VOILE_FINE_POSITION_GLSL
#define VOILE_FINE_POSITION_GLSL

struct FinePosition
{
    vec3 x;        // m
    vec3 residual; // m; the position is x + residual
};

const float k_residual_steps = 32767; // a residual's fractions, either way

// m: half the distance from the largest coordinate to the next float.
float residual_unit(vec3 x)
{
    const float largest = max(max(abs(x.x), abs(x.y)), abs(x.z));
    const uint exponent = floatBitsToUint(largest) & 0x7f800000u;
    return uintBitsToFloat(max(exponent, 25u << 23) - (24u << 23));
}

vec3 unpack_residual(vec3 x, uvec2 bits)
{
    const ivec3 fraction = ivec3(bitfieldExtract(int(bits.x), 0, 16), int(bits.x) >> 16, int(bits.y));
    return residual_unit(x) / k_residual_steps * vec3(fraction);
}

uvec2 pack_residual(FinePosition p)
{
    const ivec3 fraction = ivec3(round(p.residual / residual_unit(p.x) * k_residual_steps));
    return uvec2((fraction.x & 0xffff) | fraction.y << 16, fraction.z);
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
