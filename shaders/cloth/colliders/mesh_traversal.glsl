// Traversal of the hierarchy of a mesh, rigid (bvh_layout.h) or deforming (padded_layout.h), with a query of type VOILE_QUERY.
// May be included once per type of query.
//
// The including kernel declares `bvh_nodes[]` and `padded_boxes[]` and defines before the include
//   VOILE_QUERY, the name of a struct,
//   bool enters_node(VOILE_QUERY query, Box node), and
//   void visit_leaf(inout VOILE_QUERY query, uint first, uint count), which is called for the triangles of every leaf that
//   the query enters.
#include "colliders/padded.glsl"
#ifndef VOILE_MESH_TRAVERSAL_GLSL
#define VOILE_MESH_TRAVERSAL_GLSL

struct MeshTree
{
    bool is_padded;
    uint first_node; // or box
    uint first_leaf; // its first triangle
    uint triangles;  // of a padded one
};

MeshTree mesh_tree(ColliderRecord collider)
{
    return MeshTree(is_deforming(collider.flags), collider.first_node, collider.first_triangle, collider.triangles);
}

#endif

// One loop for both kinds of trees: what visit_leaf calls is copied once, not twice.
void traverse(inout VOILE_QUERY query, MeshTree tree)
{
    uint leaves[k_waiting_leaves];
    uint waiting = 0;
    uint stack[VOILE_BVH_MAX_DEPTH]; // of a rigid one
    uint entries = 0;
    uint node = 0;
    PaddedCursor at = k_padded_root;
    bool done = tree.is_padded && !enters_node(query, padded_box(tree.first_node));
    if (tree.is_padded && !done && tree.triangles == 1) // the root is its leaf
    {
        leaves[waiting++] = 0;
        done = true;
    }
    do
    {
        while (!done && waiting + 2 <= k_waiting_leaves)
        {
            FoundLeaves found;
            if (tree.is_padded)
                done = !next_padded(query, tree.first_node, tree.triangles, at, found);
            else
            {
                const BvhNode n = bvh_nodes[tree.first_node + node];
                const bvec2 entered = bvec2(enters_node(query, Box(n.left_min, n.left_max)),
                                            enters_node(query, Box(n.right_min, n.right_max)));
                const bvec2 leaf = bvec2((n.left & VOILE_BVH_LEAF_BIT) != 0, (n.right & VOILE_BVH_LEAF_BIT) != 0);
                found = FoundLeaves(uvec2(n.left, n.right), bvec2(entered.x && leaf.x, entered.y && leaf.y));
                const bool left = entered.x && !leaf.x;
                const bool right = entered.y && !leaf.y;
                if (left && right)
                    stack[entries++] = n.right;
                done = !left && !right && entries == 0;
                if (!done)
                    node = left ? n.left : right ? n.right : stack[--entries];
            }
            if (found.entered.x)
                leaves[waiting++] = found.leaves.x;
            if (found.entered.y)
                leaves[waiting++] = found.leaves.y;
        }
        for (uint i = 0; i < waiting; ++i)
            visit_leaf(query, tree.first_leaf + (leaves[i] & VOILE_BVH_FIRST_MASK),
                       ((leaves[i] >> VOILE_BVH_COUNT_SHIFT) & VOILE_BVH_COUNT_MASK) + 1);
        waiting = 0;
    } while (!done);
}

void traverse(inout VOILE_QUERY query, ColliderRecord collider) { traverse(query, mesh_tree(collider)); }
