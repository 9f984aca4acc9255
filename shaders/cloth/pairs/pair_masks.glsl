// The pairs that a vertex is in: one mask per owner of primitives around it (owners.glsl), with one bit per place of the
// owner's list.
#ifndef VOILE_PAIR_MASKS_GLSL
#define VOILE_PAIR_MASKS_GLSL

#include "pairs/fan.glsl"

// The place of the mask of the k-th owner. Each vertex has four; masks of the owners around mesh vertices follow those of
// all vertices.
uint mask_place(Fan fan, uint k, uint vertices)
{
    if (fan.columns > 0 || k == 0)
        return 4 * fan.center + k;
    return 4 * vertices + fan.mesh.first_owner + k - 1;
}

#endif
