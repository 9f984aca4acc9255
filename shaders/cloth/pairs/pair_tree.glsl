// The hierarchy of the primitives that vertices own: one implicit complete BVH (padded_layout.h) for all cloths, with
// one leaf per vertex. A slot's place is its index in pair_order, where cloths follow each other and vertices that are
// near each other at rest do, too.
//
// The including kernel declares cloths[] and pair_order[].
#ifndef VOILE_PAIR_TREE_GLSL
#define VOILE_PAIR_TREE_GLSL

// From the root on, the first half of a range of places, the larger one, has the slots with a bit of 0 on that level.
uint place_of_slot(uint slot, uint slots)
{
    uint place = 0;
    for (uint count = slots; count > 1; slot >>= 1)
    {
        const uint half_count = (count + 1) / 2;
        const bool second = (slot & 1u) != 0;
        place += second ? half_count : 0;
        count = second ? count - half_count : half_count;
    }
    return place;
}

bool collides_with_itself(uint cloth) { return (cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) != 0; }

// Whether the primitives of two cloths, or of one, are pairs.
bool meets(uint cloth, uint other)
{
    return cloth == other || (collides_with_itself(other) && (cloths[cloth].layers & cloths[other].layers) != 0);
}

#endif
