// How often the sweep of a vertex is halved. Where a list is almost full, the next one is made for half of the sweep: if
// layers hit each other there, a long one would meet more pairs than it has room for. It would leave no reach, and what the
// vertices lose of their motion has momentum.
//
// Where a collider or pin pushes cloth that is not enough: what has no reach keeps its velocity, so that its next sweep is no
// shorter. While such vertices have little room, sweeps are halved until they leave enough. At other times they
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

// With what the last lists, of `sweep`, found. `memory`: of the last pass, unless the host has changed the state since.
uint halvings_with(uint halvings, PairSweep sweep, uint memory)
{
    const bool crowded_list = is_of_last_pass(memory) && sweep.listed == VOILE_PAIR_CROWDED_LIST;
    return max(halvings, crowded_list ? 1 : 0);
}

#endif
