// How often the sweep of a vertex is halved. A long sweep across other cloth meets more pairs than a list has room for, so
// that the vertex may not move at all. Without a velocity its next sweep would be short. What a collider drives keeps
// its velocity, so that its sweeps are halved until they leave room.
//
// The including kernel declares pair_bounds[] and push (PairPush).
#ifndef VOILE_HALVINGS_GLSL
#define VOILE_HALVINGS_GLSL

#include "pairs/pair_pass.glsl"

const uint k_most_halvings = (1u << VOILE_PAIR_HALVING_BITS) - 1;

uint halvings_of(uint i)
{
    const uint word = pair_bounds[i].halvings;
    const uint since = (pair_pass() << VOILE_PAIR_HALVING_BITS) - word;
    const bool known = since >> VOILE_PAIR_HALVING_BITS < VOILE_PAIR_HALVED_PASSES;
    return known ? word & k_most_halvings : 0;
}

// `sweep`: m, its length in the new lists. `reach`: m, that they leave around it. Twice the sweep costs about half of
// its length in reach, so the bounds are too far apart for the number to swing.
uint next_halvings(uint i, float sweep, float reach)
{
    const uint before = halvings_of(i);
    uint next = before;
    if (reach <= 0)
        next = min(before + VOILE_PAIR_HALVINGS, k_most_halvings);
    else if (reach < 0.25 * sweep)
        next = min(before + 1, k_most_halvings);
    else if (reach > sweep)
        next = max(before, 1) - 1;
    return pair_pass() << VOILE_PAIR_HALVING_BITS | next;
}

#endif
