// How the boxes of the hierarchy of pairs are carried, so that those of cloth that falls are small: those of an island as
// most of its vertices are.
//
// The including kernel declares pair_islands[] and push (PairPush).
#ifndef VOILE_TREE_CARRY_GLSL
#define VOILE_TREE_CARRY_GLSL

#include "pairs/mean_velocity.glsl"
#include "pairs/node.glsl"
#include "pairs/sweep.glsl"

// At `x`.
Viewpoint tree_viewpoint(vec3 x, uint cloth)
{
    const uint island = island_of(cloth);
    const bool carried = 2 * pair_islands[island].clear > pair_islands[island].vertices;
    if (!carried)
        return Viewpoint(x, vec3(0), 0);
    const uint word = pack_carry(mean_velocity(island)) | k_falls_bit;
    return Viewpoint(x, unpack_half_sweep(word), fall_of(word));
}

#endif
