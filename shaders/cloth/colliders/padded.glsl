// Traversal of an implicit complete BVH (padded_layout.h) with a box.
//
// The including kernel declares `padded_boxes[]` and defines boxes_overlap and, before the include,
//   void take_leaf(uint first, uint count)
// which is called with a count of 1 for every leaf that the traversal enters, once per triangle. VOILE_ENTERS: as in
// bvh.glsl.
#ifndef VOILE_PADDED_GLSL
#define VOILE_PADDED_GLSL

#ifndef VOILE_ENTERS
#define VOILE_ENTERS boxes_overlap
#endif

// As in bvh.glsl.
const uint k_padded_waiting_leaves = 8;

bool padded_box_overlaps(uint box, vec3 box_min, vec3 box_max)
{
    const PaddedBox b = padded_boxes[box];
    return VOILE_ENTERS(box_min, box_max, b.min, b.max);
}

// The ancestors of a box are its index modulo the widths of their levels, so the stack is one word: bit d is set if the
// second child of the current ancestor on level d is still to visit.
void visit_padded(uint first_box, uint first_leaf, uint triangles, vec3 box_min, vec3 box_max)
{
    const uint last = 1u << findMSB(2 * triangles - 1); // width of the level of leaves
    uint leaves[k_padded_waiting_leaves];
    uint waiting = 0;
    uint second = 0;
    uint width = 1; // of the level
    uint box = 0;   // on it
    const bool entered = padded_box_overlaps(first_box, box_min, box_max);
    bool done = !entered || last == 1;
    if (entered && last == 1) // one triangle: the root is its leaf
        leaves[waiting++] = 0;
    do
    {
        while (!done && waiting + 2 <= k_padded_waiting_leaves)
        {
            const uint child = first_box + 2 * width - 1 + box;
            bool left = padded_box_overlaps(child, box_min, box_max);
            bool right = padded_box_overlaps(child + width, box_min, box_max);
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
            take_leaf(first_leaf + leaves[i], 1);
        waiting = 0;
    } while (!done);
}

#endif
