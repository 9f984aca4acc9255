// Counting of intersecting pairs, and marks of their vertices.
//
// The including kernel declares intersections[] and push (IntersectionPush).
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

// False: the device ends all loops of this thread early, as Mesa does after 65,535 rounds. Compilers know that a traversal is
// done where its loop ends, but not how often this one has run.
bool runs_loops()
{
    const uint rounds = push.levels + 2;
    uint i = 0;
    while (i < rounds)
        ++i;
    return i == rounds;
}

#endif
