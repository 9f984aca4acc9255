// The point of a cloth from which sums over it measure positions (pair_layout.h): a vertex.
//
// The including kernel declares cloths[] and positions[].
#ifndef VOILE_CLOTH_ORIGIN_GLSL
#define VOILE_CLOTH_ORIGIN_GLSL

#include "shared/finite.glsl"

vec3 origin_of(uint cloth) // m
{
    const vec3 first = positions[cloths[cloth].first_vertex].xyz;
    return is_finite(first) ? first : vec3(0);
}

#endif
