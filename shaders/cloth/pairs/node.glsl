// Vertices of primitives as searches see them.
//
// The including kernel declares midpoints[] and pair_carries[].
#ifndef VOILE_NODE_GLSL
#define VOILE_NODE_GLSL

#include "pairs/sweep.glsl"
#include "shared/step_input.glsl"

// The point from which a search looks at vertices. It is carried, too.
struct Viewpoint
{
    vec3 x;     // m, halfway
    vec3 carry; // m, half of its way
    float fall; // m: how far the clock may carry it beyond that (fall.glsl); 0: gravity does not accelerate it
};

// A vertex halfway along its sweep, and halfway of where it is carried.
struct Node
{
    vec3 x;     // m, from the viewpoint
    vec3 sweep; // m, half of it
    vec3 carry; // m, half of it, relative to the viewpoint's
    float fall; // m: how far the clock may carry it beyond that
    uint vertex;
};

// m: packing a sweep rounds each axis of its half by at most half a unit.
float fall_of(uint word) { return falls(word) * (step_input.pair_fall + 2 * sweep_unit(word)); }

// m, relative to each other. What falls freely has the same carry.
float fall_between(float a, float b) { return a > 0 && b > 0 ? 0 : max(a, b); }

Viewpoint viewpoint_of(uint vertex)
{
    return Viewpoint(midpoints[vertex].xyz, unpack_half_sweep(pair_carries[vertex]), fall_of(pair_carries[vertex]));
}

Node node_of(uint vertex, Viewpoint from)
{
    const vec4 midpoint = midpoints[vertex];
    return Node(midpoint.xyz - from.x, unpack_half_sweep(floatBitsToUint(midpoint.w)),
                unpack_half_sweep(pair_carries[vertex]) - from.carry,
                fall_between(fall_of(pair_carries[vertex]), from.fall), vertex);
}

// m: how far the vertex may be from its middle along each axis.
vec3 extent_of(Node node) { return abs(node.sweep) + abs(node.carry) + node.fall; }

#endif
