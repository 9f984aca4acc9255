// Traversal of an implicit complete BVH (padded_layout.h) with a query of type VOILE_QUERY, as in bvh.glsl. May be
// included once per type of query.
//
// The including kernel declares `padded_boxes[]` and defines before the include what bvh.glsl expects. visit_leaf is
// called with a count of 1, once per triangle.
#ifndef VOILE_PADDED_GLSL
#define VOILE_PADDED_GLSL

#include "colliders/padded_box.glsl"

// As in bvh.glsl.
const uint k_padded_waiting_leaves = 8;

#endif

// The ancestors of a box are its index modulo the widths of their levels, so the stack is one word: bit d is set if the
// second child of the current ancestor on level d is still to visit.
void traverse_padded(inout VOILE_QUERY query, uint first_box, uint first_leaf, uint triangles)
{
    const uint last = 1u << findMSB(2 * triangles - 1); // width of the level of leaves
    uint leaves[k_padded_waiting_leaves];
    uint waiting = 0;
    uint second = 0;
    uint width = 1; // of the level
    uint box = 0;   // on it
    const bool entered = enters_node(query, padded_box(first_box));
    bool done = !entered || last == 1;
    if (entered && last == 1) // one triangle: the root is its leaf
        leaves[waiting++] = 0;
    do
    {
        while (!done && waiting + 2 <= k_padded_waiting_leaves)
        {
            const uint child = first_box + 2 * width - 1 + box;
            bool left = enters_node(query, padded_box(child));
            bool right = enters_node(query, padded_box(child + width));
            if (2 * width == last)
            {
                if (left)
                    leaves[waiting++] = box;
                if (right && box + width < triangles) // a slot past the triangles repeats its sibling
                    leaves[waiting++] = box + width;
                left = right = false;
            }
            if (left && right)
                second |= width;
            done = !left && !right && second == 0;
            if (done)
                break;
            if (!left && !right)
            {
                width = 1u << findMSB(second);
                second ^= width;
                box &= width - 1;
                right = true;
            }
            box += left ? 0 : width;
            width *= 2;
        }
        for (uint i = 0; i < waiting; ++i)
            visit_leaf(query, first_leaf + leaves[i], 1);
        waiting = 0;
    } while (!done);
}
