// Traversal of an implicit complete BVH (padded_layout.h) with a query of type VOILE_QUERY. May be included once per type of
// query.
//
// The including kernel declares `padded_boxes[]` and defines before the include what mesh_traversal.glsl expects. visit_leaf
// is called with a count of 1, once per triangle. VOILE_LEAVES_VISITED(query), if it is defined, is called after every few leaves.
#ifndef VOILE_PADDED_GLSL
#define VOILE_PADDED_GLSL

#include "colliders/padded_box.glsl"

// A box whose children come next. The ancestors of a box are its index modulo the widths of their levels, so the stack is one
// word: bit d is set if the second child of the current ancestor on level d is still to visit.
struct PaddedCursor
{
    uint width; // of the level
    uint box;   // on it
    uint second;
};

const PaddedCursor k_padded_root = PaddedCursor(1, 0, 0);

// What a step of a traversal finds: the leaves below a node, and which of these the query enters.
struct FoundLeaves
{
    uvec2 leaves;
    bvec2 entered;
};

#endif

// Enters the children of the cursor's box, which is no leaf, and moves on. False: none is left.
bool next_padded(VOILE_QUERY query, uint first_box, uint triangles, inout PaddedCursor at, out FoundLeaves found)
{
    const uint child = first_box + 2 * at.width - 1 + at.box;
    bool left = enters_node(query, padded_box(child));
    bool right = enters_node(query, padded_box(child + at.width));
    found = FoundLeaves(uvec2(at.box, at.box + at.width), bvec2(false));
    if (2 * at.width == 1u << findMSB(2 * triangles - 1)) // the level of leaves
    {
        found.entered = bvec2(left, right && found.leaves.y < triangles); // a slot past the triangles repeats its sibling
        left = right = false;
    }
    if (left && right)
        at.second |= at.width;
    if (!left && !right)
    {
        if (at.second == 0)
            return false;
        at.width = 1u << findMSB(at.second);
        at.second ^= at.width;
        at.box &= at.width - 1;
        right = true;
    }
    at.box += left ? 0 : at.width;
    at.width *= 2;
    return true;
}

void traverse_padded(inout VOILE_QUERY query, uint first_box, uint first_leaf, uint triangles)
{
    uint leaves[k_waiting_leaves];
    uint waiting = 0;
    PaddedCursor at = k_padded_root;
    bool done = !enters_node(query, padded_box(first_box));
    if (!done && triangles == 1) // the root is its leaf
    {
        leaves[waiting++] = 0;
        done = true;
    }
    do
    {
        while (!done && waiting + 2 <= k_waiting_leaves)
        {
            FoundLeaves found;
            done = !next_padded(query, first_box, triangles, at, found);
            if (found.entered.x)
                leaves[waiting++] = found.leaves.x;
            if (found.entered.y)
                leaves[waiting++] = found.leaves.y;
        }
        for (uint i = 0; i < waiting; ++i)
            visit_leaf(query, first_leaf + leaves[i], 1);
#ifdef VOILE_LEAVES_VISITED
        VOILE_LEAVES_VISITED(query);
#endif
        waiting = 0;
    } while (!done);
}
