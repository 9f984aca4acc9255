// Counting of intersecting pairs, and marks of their vertices.
//
// The including kernel declares intersections[].
#ifndef VOILE_TALLY_GLSL
#define VOILE_TALLY_GLSL

#include "intersections/edge_triangle.glsl"

struct Tally
{
    uint pairs;
    uint uncertain;
};

void mark(uvec3 vertices, uint bit)
{
    for (uint i = 0; i < 3; ++i)
        atomicOr(intersections[vertices[i]], bit);
}

// Counts a pair and returns whether it may intersect.
bool count(inout Tally tally, int result)
{
    if (result == k_apart)
        return false;
    ++tally.pairs;
    tally.uncertain += result == k_uncertain ? 1 : 0;
    return true;
}

#endif
