// Unit vectors in 32 bits: the octahedral map of Meyer et al. 2010, "On floating-point normal vectors".
#ifndef VOILE_DIRECTION_GLSL
#define VOILE_DIRECTION_GLSL

uint pack_direction(vec3 n)
{
    const vec2 p = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
    const vec2 signs = vec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1);
    return packSnorm2x16(n.z >= 0 ? p : (1 - abs(p.yx)) * signs);
}

vec3 unpack_direction(uint packed)
{
    const vec2 p = unpackSnorm2x16(packed);
    vec3 n = vec3(p, 1 - abs(p.x) - abs(p.y));
    const float below = max(-n.z, 0);
    n.xy += vec2(n.x >= 0 ? -below : below, n.y >= 0 ? -below : below);
    return normalize(n);
}

#endif
