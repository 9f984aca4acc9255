// The word of PairMemory::pass: the number of the pass, and how often the sweep of the vertex is halved.
//
// The including kernel declares push (PairPush).
#ifndef VOILE_MEMORY_GLSL
#define VOILE_MEMORY_GLSL

#include "pairs/pair_pass.glsl"

const uint k_most_halvings = (1u << VOILE_PAIR_HALVING_BITS) - 1;

// Passes since then.
uint passes_since(uint word)
{
    return ((pair_pass() << VOILE_PAIR_HALVING_BITS) - (word & ~k_most_halvings)) >> VOILE_PAIR_HALVING_BITS;
}

bool is_of_last_pass(uint word) { return passes_since(word) == 1; }

uint halvings_of(uint word) { return passes_since(word) < VOILE_PAIR_HALVED_PASSES ? word & k_most_halvings : 0; }

uint with_halvings(uint word, uint halvings) { return (word & ~k_most_halvings) | halvings; }

// Of this pass.
uint memory_word(uint halvings) { return (pair_pass() << VOILE_PAIR_HALVING_BITS) | halvings; }

#endif
