// The including kernel declares pair_searches[].
#ifndef VOILE_FORCED_GLSL
#define VOILE_FORCED_GLSL

// A pair that may intersect, because of a vertex without mass.
void count_forced()
{
    atomicAdd(pair_searches[VOILE_PAIR_FORCED].entries, 1);
    pair_searches[VOILE_PAIR_UNTANGLED].entries = 0;
}

#endif
