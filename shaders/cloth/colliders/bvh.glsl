// Traversal of a bounding volume hierarchy with a query of type VOILE_QUERY. May be included once per type of query.
//
// The including kernel declares `bvh_nodes[]` and defines before the include
//   VOILE_QUERY, the name of a struct,
//   bool enters_node(VOILE_QUERY query, Box node), and
//   void visit_leaf(inout VOILE_QUERY query, uint first, uint count), which is called for the triangles of every leaf that
//   the query enters.
#ifndef VOILE_BVH_GLSL
#define VOILE_BVH_GLSL

// Leaves that wait until a thread has several. Neighboring threads find theirs at different iterations. Taking them
// together keeps the triangle tests out of the loop over nodes.
const uint k_bvh_waiting_leaves = 8;

#endif

void traverse_bvh(inout VOILE_QUERY query, uint first_node, uint first_triangle)
{
    uint stack[VOILE_BVH_MAX_DEPTH];
    uint entries = 0;
    uint leaves[k_bvh_waiting_leaves];
    uint waiting = 0;
    uint node = 0;
    bool done = false;
    while (!done)
    {
        while (waiting + 2 <= k_bvh_waiting_leaves)
        {
            const BvhNode n = bvh_nodes[first_node + node];
            const bool left = enters_node(query, Box(n.left_min, n.left_max));
            const bool right = enters_node(query, Box(n.right_min, n.right_max));
            const bool left_leaf = (n.left & VOILE_BVH_LEAF_BIT) != 0;
            const bool right_leaf = (n.right & VOILE_BVH_LEAF_BIT) != 0;
            if (left && left_leaf)
                leaves[waiting++] = n.left;
            if (right && right_leaf)
                leaves[waiting++] = n.right;
            const bool go_left = left && !left_leaf;
            const bool go_right = right && !right_leaf;
            if (go_left && go_right)
                stack[entries++] = n.right;
            done = !go_left && !go_right && entries == 0;
            if (done)
                break;
            node = go_left ? n.left : go_right ? n.right : stack[--entries];
        }
        for (uint i = 0; i < waiting; ++i)
            visit_leaf(query, first_triangle + (leaves[i] & VOILE_BVH_FIRST_MASK),
                       ((leaves[i] >> VOILE_BVH_COUNT_SHIFT) & VOILE_BVH_COUNT_MASK) + 1);
        waiting = 0;
    }
}
