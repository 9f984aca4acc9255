// Vertices of primitives as searches see them.
//
// The including kernel declares midpoints[].
#ifndef VOILE_NODE_GLSL
#define VOILE_NODE_GLSL

#include "pairs/sweep.glsl"

// A vertex halfway along its sweep.
struct Node
{
    vec3 x;     // m, from an origin
    vec3 sweep; // m, half of it
    uint vertex;
};

Node node_of(uint vertex, vec3 origin)
{
    const vec4 midpoint = midpoints[vertex];
    return Node(midpoint.xyz - origin, unpack_half_sweep(floatBitsToUint(midpoint.w)), vertex);
}

#endif
