// Vertices of primitives as searches see them.
//
// The including kernel declares midpoints[] and pair_carries[].
#ifndef VOILE_NODE_GLSL
#define VOILE_NODE_GLSL

#include "pairs/sweep.glsl"

// The point from which a search looks at vertices. It is carried, too.
struct Viewpoint
{
    vec3 x;     // m, halfway
    vec3 carry; // m, half of its way
};

// A vertex halfway along its sweep, and halfway of where it is carried.
struct Node
{
    vec3 x;     // m, from the viewpoint
    vec3 sweep; // m, half of it
    vec3 carry; // m, half of it, relative to the viewpoint's
    uint vertex;
};

Viewpoint viewpoint_of(uint vertex)
{
    return Viewpoint(midpoints[vertex].xyz, unpack_half_sweep(pair_carries[vertex]));
}

Node node_of(uint vertex, Viewpoint from)
{
    const vec4 midpoint = midpoints[vertex];
    return Node(midpoint.xyz - from.x, unpack_half_sweep(floatBitsToUint(midpoint.w)),
                unpack_half_sweep(pair_carries[vertex]) - from.carry, vertex);
}

// m: how far the vertex may be from its middle along each axis.
vec3 extent_of(Node node) { return abs(node.sweep) + abs(node.carry); }

#endif
