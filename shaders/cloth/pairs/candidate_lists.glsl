// The lists of candidates of a vertex during a search, one for each vertex of a leaf. The mask of its list of pairs has
// their lengths.
#ifndef VOILE_CANDIDATE_LISTS_GLSL
#define VOILE_CANDIDATE_LISTS_GLSL

uint length_of(uint lengths, uint list) { return lengths >> list * VOILE_PAIR_LENGTH_BITS & VOILE_PAIR_LENGTH_MASK; }

// Of every `step`-th list, from `first` on.
uint sum_of_lengths(uint lengths, uint first, uint step)
{
    uint sum = 0;
    for (uint list = first; list < VOILE_PAIR_LEAF; list += step)
        sum += length_of(lengths, list);
    return sum;
}

// The place of a candidate among those of all vertices.
uint candidate_place(uint vertex, uint list, uint k)
{
    return vertex * VOILE_PAIR_CANDIDATES + list * VOILE_PAIR_CANDIDATE_LIST + k;
}

#endif
