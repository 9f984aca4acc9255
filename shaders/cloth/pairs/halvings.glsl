// How often the sweep of a vertex is halved. A long sweep across other cloth meets more pairs than a list has room for, so
// that the vertex may not move at all. It loses its velocity then, and its next sweep is short. What a collider pushes
// keeps its velocity. While such vertices have little room, sweeps are halved until they leave enough. At other times they
// are not: shorter sweeps make lists more often, for all cloth (measured: twice the time of a frame).
//
// The including kernel declares pair_searches[] and push (PairPush).
#ifndef VOILE_HALVINGS_GLSL
#define VOILE_HALVINGS_GLSL

#include "pairs/memory.glsl"

bool is_crowded()
{
    return pair_pass() + 1 - pair_searches[VOILE_PAIR_CROWDED].entries <= VOILE_PAIR_CROWDED_PASSES;
}

// `sweep`: of the last lists. `displacement`: m, until the next pass, relative to what carries the vertex. Twice the
// sweep costs about half of its length in reach.
uint next_halvings(uint before, PairSweep sweep, float displacement)
{
    if (!is_crowded() || sweep.reach - VOILE_PAIR_APPROACH * length(sweep.sweep) > 1.5 * displacement)
        return max(before, 1) - 1;
    return min(before + (sweep.reach <= 0 ? VOILE_PAIR_HALVINGS : sweep.reach < displacement ? 1 : 0), k_most_halvings);
}

#endif
