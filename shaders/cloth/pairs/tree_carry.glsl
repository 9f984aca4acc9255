// How the boxes of the hierarchy of pairs are carried, so that those of cloth that falls are small.
//
// The including kernel declares pair_order[], pair_carries[] and push.places.
#ifndef VOILE_TREE_CARRY_GLSL
#define VOILE_TREE_CARRY_GLSL

#include "pairs/node.glsl"
#include "pairs/sweep.glsl"

// m, half of the way: the mean of some vertices'.
vec3 tree_carry()
{
    const uint samples = 4;
    vec3 sum = vec3(0);
    for (uint k = 0; k < samples; ++k)
        sum += unpack_half_sweep(pair_carries[pair_order[(2 * k + 1) * push.places / (2 * samples)].x]);
    return sum / float(samples);
}

// m, beyond that (node.glsl): as vertices in the middle, if they fall freely.
float tree_fall() { return fall_of(pair_carries[pair_order[push.places / 2].x]); }

#endif
