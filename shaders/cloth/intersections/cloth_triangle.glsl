// Triangles of cloths.
//
// The including kernel declares cloth_leaves[] and positions[].
#ifndef VOILE_CLOTH_TRIANGLE_GLSL
#define VOILE_CLOTH_TRIANGLE_GLSL

#include "intersections/edge_triangle.glsl"
#include "shared/finite.glsl"

// A triangle of a cloth, in the world.
struct ClothTriangle
{
    uvec3 vertices; // in the solver's buffers
    uint edges;     // that it owns, one bit each
    vec3 corners[3];
};

bool is_finite(ClothTriangle t)
{
    return is_finite(t.corners[0]) && is_finite(t.corners[1]) && is_finite(t.corners[2]);
}

uint owned_edges(PaddedLeaf leaf) { return (leaf.triangle >> VOILE_PADDED_EDGE_SHIFT) & 7u; }

// The triangle in a slot of a cloth's hierarchy.
ClothTriangle cloth_triangle(uint slot, uint first_vertex)
{
    const PaddedLeaf leaf = cloth_leaves[slot];
    ClothTriangle result;
    result.vertices = first_vertex + leaf.corners;
    result.edges = owned_edges(leaf);
    for (uint i = 0; i < 3; ++i)
        result.corners[i] = snapped(positions[result.vertices[i]].xyz);
    return result;
}

Box box_of(ClothTriangle t) { return triangle_box(t.corners[0], t.corners[1], t.corners[2]); }

// The slot of a thread in a tree of 2^levels slots. Slots under one box are far apart in memory; neighboring threads
// take neighboring triangles.
uint slot_of(uint thread, uint levels) { return levels == 0 ? 0 : bitfieldReverse(thread) >> (32 - levels); }

#endif
