// The features near the pieces of a thread: those that its workgroup has gathered, or, where more are near than fit, those
// that a traversal of the hierarchy finds.
//
// On GPUs the threads of a workgroup then take turns together, in each of which one looks at a node or at a feature. If each
// had a loop of its own, it would come to the barrier after that before the others of its warp, and a driver lets it pass:
// see "Loops of single threads before barriers" in bench/NOTES.md. On CPU devices each has a loop of its own, which is
// faster, unless Tuning::feature_threads is given.
//
// The including kernel includes feature_gathering.glsl and padded_box.glsl and defines FeatureSearch, select_piece and
// visit_feature before. It sets turns[] to 0.
#ifndef VOILE_FEATURE_TRAVERSAL_GLSL
#define VOILE_FEATURE_TRAVERSAL_GLSL

layout(constant_id = k_constant_together) const uint TOGETHER = 1; // threads traverse in turns

shared uint turns[3]; // whether a thread has taken part in one; the last three

bool enters_node(FeatureSearch search, Box node) { return overlap(search.box, node); }

void visit_slot(inout FeatureSearch search, uint slot)
{
    const DeformingSet set = deforming_set(search.collider);
    const uint first = feature_slots[slot] >> VOILE_SLOT_FEATURE_BITS;
    const uint count = feature_slots[slot] & ((1u << VOILE_SLOT_FEATURE_BITS) - 1);
    for (uint f = first; f < first + count; ++f)
        if (protrudes(set, f))
            visit_feature(search, f, near_feature(search.collider, f, true));
}

// Of a mesh that deforms a leaf is a slot.
void visit_leaf(inout FeatureSearch search, uint first, uint count)
{
    if (search.deforms)
        visit_slot(search, first);
    else
        for (uint f = first; f < first + count; ++f)
            visit_feature(search, f, near_feature(search.collider, f, false));
}

#define VOILE_QUERY FeatureSearch
#include "colliders/bvh.glsl"
#include "colliders/padded.glsl"

// Near the piece of this thread.
void visit_features(inout FeatureSearch search, FeatureTree tree, Gathering gathering)
{
    if (gathering.crowded && search.deforms)
        traverse_padded(search, tree.first_node, tree.first_leaf, tree.triangles);
    else if (gathering.crowded)
        traverse_bvh(search, tree.first_node, tree.first_leaf);
    for (uint f = gathering.first; f < gathering.end; ++f)
    {
        const NearFeature near = gathered_feature(f);
        if (overlap(search.box, swept_box(near)))
            visit_feature(search, gathered[f], near);
    }
}

// What a thread has still to look at.
struct Traversal
{
    uint piece;  // the next one of the vertex
    uint pieces; // it ends with this one
    uint nodes[VOILE_BVH_MAX_DEPTH + 1]; // a stack; the words of leaves
    uint count;
    uint feature; // the next one of a leaf
    uint end;     // of that leaf
};

void enter(inout Traversal traversal, Box near, uint node, Box box)
{
    if (overlap(near, box))
        traversal.nodes[traversal.count++] = node;
}

// Looks at the node on top. Of a mesh that deforms a leaf is a slot.
void visit_node(inout Traversal traversal, FeatureTree tree, Box near)
{
    const uint node = traversal.nodes[--traversal.count];
    const uint width = padded_width(node);
    if (tree.deforms && width < tree.triangles)
    {
        enter(traversal, near, node + 2 * width, padded_box(tree.first_node + node + 2 * width));
        enter(traversal, near, node + width, padded_box(tree.first_node + node + width));
    }
    else if (tree.deforms)
    {
        const uint slot = node + 1 - width;
        if (slot >= tree.triangles)
            return; // repeats another one
        const uint features = feature_slots[tree.first_leaf + slot];
        traversal.feature = features >> VOILE_SLOT_FEATURE_BITS;
        traversal.end = traversal.feature + (features & ((1u << VOILE_SLOT_FEATURE_BITS) - 1));
    }
    else if ((node & VOILE_BVH_LEAF_BIT) != 0)
    {
        traversal.feature = tree.first_leaf + (node & VOILE_BVH_FIRST_MASK);
        traversal.end = traversal.feature + (node >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK) + 1;
    }
    else
    {
        const BvhNode n = bvh_nodes[tree.first_node + node];
        enter(traversal, near, n.right, Box(n.right_min, n.right_max));
        enter(traversal, near, n.left, Box(n.left_min, n.left_max));
    }
}

void start_piece(inout FeatureSearch search, inout Traversal traversal, FeatureTree tree, Space space)
{
    if (select_piece(search, space, traversal.piece))
        traversal.nodes[traversal.count++] = 0;
    traversal.piece += push.lanes;
}

// False: the thread is done.
bool take_turn(inout FeatureSearch search, inout Traversal traversal, FeatureTree tree, Space space)
{
    if (traversal.feature < traversal.end)
    {
        const uint f = traversal.feature++;
        if (!tree.deforms || protrudes(deforming_set(tree.collider), f))
            visit_feature(search, f, near_feature(tree.collider, f, tree.deforms));
    }
    else if (traversal.count > 0)
        visit_node(traversal, tree, search.box);
    else if (traversal.piece < traversal.pieces)
        start_piece(search, traversal, tree, space);
    else
        return false;
    return true;
}

// Near all pieces of this thread, of `count` that the vertex has. All threads of the workgroup call it; those without
// pieces wait for the others.
void traverse_together(inout FeatureSearch search, FeatureTree tree, Space space, uint lane, uint count)
{
    Traversal traversal;
    traversal.piece = lane;
    traversal.pieces = count;
    traversal.count = traversal.feature = traversal.end = 0;
    barrier();
    for (uint turn = 0;; ++turn)
    {
        if (take_turn(search, traversal, tree, space))
            turns[turn % 3] = 1;
        barrier();
        const bool ends = turns[turn % 3] == 0;
        if (gl_LocalInvocationID.x == 0)
            turns[(turn + 2) % 3] = 0; // all threads have read it
        if (ends)
            return;
    }
}

#endif
