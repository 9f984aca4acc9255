// The hierarchy of the primitives that vertices own: one implicit complete BVH (padded_layout.h) for all cloths. In
// pair_order cloths follow each other, and vertices that are near each other at rest do, too. Each VOILE_PAIR_LEAF
// vertices have a leaf.
//
// The including kernel declares cloths[].
#ifndef VOILE_PAIR_TREE_GLSL
#define VOILE_PAIR_TREE_GLSL

// The leaf in a slot. From the root on, the first half of a range of leaves, the larger one, has the slots with a bit of
// 0 on that level.
uint leaf_of_slot(uint slot, uint leaves)
{
    uint leaf = 0;
    for (uint count = leaves; count > 1; slot >>= 1)
    {
        const uint half_count = (count + 1) / 2;
        const bool second = (slot & 1u) != 0;
        leaf += second ? half_count : 0;
        count = second ? count - half_count : half_count;
    }
    return leaf;
}

bool collides_with_itself(uint cloth) { return (cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) != 0; }

// Whether the primitives of two cloths, or of one, are pairs.
bool meets(uint cloth, uint other)
{
    return cloth == other || (collides_with_itself(other) && (cloths[cloth].layers & cloths[other].layers) != 0);
}

#endif
