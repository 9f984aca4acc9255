// A traversal of the hierarchy of a collider's features by a workgroup: which of them are near its vertices.
//
// The threads visit one node each at a time. A thread that traversed alone would wait for memory at every node, and where
// features are dense the whole dispatch would wait for that thread. Where more are near than a list has room for, the
// traversal stops whenever the list is full, and goes on after that has been emptied. Then few nodes are visited at a time,
// in an order that depends on no order of threads.
//
// Vertices that follow each other need not be close: those of a skirt make an arc that a leg is in. So they are divided into
// parts, and a node is visited if it is near one of these.
//
// The including kernel declares bvh_nodes[], feature_slots[], padded_boxes[] and push (NearFeaturesPush), and includes
// box.glsl, padded_box.glsl and near_feature.glsl before. It declares scratch[], where the list is, the list's length,
// k_most_found, and FEWER_ROUNDS (bindings.h).
#ifndef VOILE_FEATURE_TRAVERSAL_GLSL
#define VOILE_FEATURE_TRAVERSAL_GLSL

#include "shared/ordered.glsl"

const uint k_most_nodes = 256;   // that wait to be visited
const uint k_ordered_nodes = 16; // visited at a time in order
const uint k_most_left = 14;     // features that a node leaves: 4 of each leaf, 7 of each slot
const uint k_parts = 16;         // of the workgroup's vertices, each with boxes of its own

shared uint found_count;                   // of the list, or more
shared uvec2 left_counts[k_ordered_nodes]; // nodes and features that each of the visited nodes leaves
shared uint nodes[k_most_nodes];           // that wait, a stack
shared uint node_count;
shared uint sweep_is_near;
// Minima and maxima of the two boxes of each part and of the workgroup, as floats, and of a chunk of features, ordered.
const uint k_chunk_corners = 12 * (k_parts + 1);
shared uint corners[k_chunk_corners + 6];

// Of a vertex or a workgroup, in the space of a collider.
struct GroupBoxes
{
    Box pieces; // of cloth, with their margins
    Box sweep;  // what they may reach until the next pass
};

bool is_finite(Box box) { return all(lessThan(abs(box.min), vec3(3e38))) && all(lessThan(abs(box.max), vec3(3e38))); }

void join_corners(uint first, Box box)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        atomicMin(corners[first + axis], ordered(box.min[axis]));
        atomicMax(corners[first + 3 + axis], ordered(box.max[axis]));
    }
}

Box joined_corners(uint first)
{
    Box result;
    for (int axis = 0; axis < 3; ++axis)
    {
        result.min[axis] = uintBitsToFloat(corners[first + axis]);
        result.max[axis] = uintBitsToFloat(corners[first + 3 + axis]);
    }
    return result;
}

// Joins the boxes of the threads that `have` them, those of each part for is_near_part, and returns the unions of all.
// Those that are not finite are left out. All threads of the workgroup call it.
GroupBoxes joined_of_group(bool have, GroupBoxes own)
{
    const uint thread = gl_LocalInvocationID.x;
    const uint part = 12 * (thread * k_parts / gl_WorkGroupSize.x);
    const uint all_parts = 12 * k_parts;
    barrier();
    for (uint i = thread; i < k_chunk_corners; i += gl_WorkGroupSize.x)
        corners[i] = ordered(i % 6 < 3 ? 3e38 : -3e38);
    barrier();
    if (have && is_finite(own.pieces) && is_finite(own.sweep))
    {
        join_corners(part, own.pieces);
        join_corners(part + 6, own.sweep);
        join_corners(all_parts, own.pieces);
        join_corners(all_parts + 6, own.sweep);
    }
    barrier();
    for (uint i = thread; i < k_chunk_corners; i += gl_WorkGroupSize.x)
        corners[i] = floatBitsToUint(from_ordered(corners[i]));
    barrier();
    return GroupBoxes(joined_corners(all_parts), joined_corners(all_parts + 6));
}

// Whether a node overlaps one of the parts' boxes. `all`: their union. `first`: the corners of the first one. Four parts per
// round are slow on GPUs, but Mesa's CPU devices end the loops of a thread after a number of rounds (bench/NOTES.md).
bool is_near_part(Box all, uint first, Box node)
{
    bool result = false;
    if (overlap(all, node))
        for (uint part = 0; part < k_parts && !result; part += FEWER_ROUNDS != 0 ? 4 : 1)
        {
            result = overlap(joined_corners(12 * part + first), node);
            if (FEWER_ROUNDS != 0)
                result = any(bvec4(result, overlap(joined_corners(12 * part + 12 + first), node),
                                   overlap(joined_corners(12 * part + 24 + first), node),
                                   overlap(joined_corners(12 * part + 36 + first), node)));
        }
    return result;
}

bool is_near_pieces(GroupBoxes boxes, Box node) { return is_near_part(boxes.pieces, 0, node); }
bool is_near_sweep(GroupBoxes boxes, Box node) { return is_near_part(boxes.sweep, 6, node); }

// The hierarchy of a collider's features. That of a mesh that deforms is the one of its triangles (padded_layout.h).
struct FeatureTree
{
    uint collider;
    bool deforms;
    uint first_node; // or box
    uint first_leaf; // feature or slot
    uint triangles;  // of a mesh that deforms
};

FeatureTree feature_tree(uint c, FeatureSet set, bool deforms)
{
    if (deforms)
        return FeatureTree(c, true, colliders[c].first_node, set.first_node, colliders[c].triangles);
    return FeatureTree(c, false, set.first_node, set.first_feature, 0);
}

// What a traversal looks for.
struct Aim
{
    FeatureTree tree;
    GroupBoxes boxes;
    bool looks; // for a feature in the sweep, as none is known to be there
};

// What remains of a node that has been visited: children to visit, and features, for each child one bit after its first.
struct Visit
{
    uvec2 nodes;
    uint node_count;
    uvec2 firsts;
    uvec2 bits;
};

void leave_node(inout Visit visit, uint node)
{
    visit.nodes = visit.node_count == 0 ? uvec2(node, 0) : uvec2(visit.nodes.x, node);
    ++visit.node_count;
}

// Of a mesh that deforms: one bit per feature of the slot that protrudes.
uint protruding(uint slot, FeatureTree tree)
{
    const DeformingSet set = deforming_set(tree.collider);
    const uint first = feature_slots[slot] >> VOILE_SLOT_FEATURE_BITS;
    const uint count = feature_slots[slot] & ((1u << VOILE_SLOT_FEATURE_BITS) - 1);
    uint bits = 0;
    for (uint i = 0; i < count; ++i)
        bits |= protrudes(set, first + i) ? 1u << i : 0;
    return bits;
}

// Notes whether a feature is in the sweep. Returns whether the children of a node must be visited.
//
// A node that overlaps the sweep and is small has one near it.
bool visit_box(Box box, Aim aim, bool is_leaf, bool near_pieces)
{
    const float coarse = sudden_reach();
    bool in_sweep = aim.looks && is_near_sweep(aim.boxes, box);
    const vec3 size = box.max - box.min;
    if (in_sweep && (is_leaf || max(max(size.x, size.y), size.z) <= coarse))
    {
        sweep_is_near = 1;
        in_sweep = false;
    }
    return !is_leaf && (in_sweep || near_pieces);
}

void visit_child(inout Visit visit, uint i, uint child, Box box, Aim aim)
{
    const bool is_leaf = (child & VOILE_BVH_LEAF_BIT) != 0;
    const bool near_pieces = is_near_pieces(aim.boxes, box);
    if (visit_box(box, aim, is_leaf, near_pieces))
        leave_node(visit, child);
    if (!is_leaf || !near_pieces)
        return;
    visit.firsts[i] = aim.tree.first_leaf + (child & VOILE_BVH_FIRST_MASK);
    visit.bits[i] = (2u << (child >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK)) - 1;
}

uint padded_width(uint node) { return 1u << findMSB(node + 1); }

// `node`: its index in the tree.
void visit_padded(inout Visit visit, uint i, uint node, Aim aim)
{
    const FeatureTree tree = aim.tree;
    const uint width = padded_width(node);
    const uint index = node + 1 - width;
    const bool is_leaf = width >= tree.triangles; // the last level
    if (is_leaf && index >= tree.triangles)
        return; // repeats another slot
    const Box box = padded_box(tree.first_node + node);
    const bool near_pieces = is_near_pieces(aim.boxes, box);
    if (visit_box(box, aim, is_leaf, near_pieces))
        leave_node(visit, node);
    if (!is_leaf || !near_pieces)
        return;
    visit.firsts[i] = feature_slots[tree.first_leaf + index] >> VOILE_SLOT_FEATURE_BITS;
    visit.bits[i] = protruding(tree.first_leaf + index, tree);
}

const Visit k_no_visit = Visit(uvec2(0), 0, uvec2(0), uvec2(0));

Visit visit_children(uint node, Aim aim)
{
    Visit visit = k_no_visit;
    if (aim.tree.deforms)
    {
        const uint width = padded_width(node);
        visit_padded(visit, 0, node + width, aim);
        visit_padded(visit, 1, node + 2 * width, aim);
        return visit;
    }
    const BvhNode n = bvh_nodes[aim.tree.first_node + node];
    visit_child(visit, 0, n.left, Box(n.left_min, n.left_max), aim);
    visit_child(visit, 1, n.right, Box(n.right_min, n.right_max), aim);
    return visit;
}

// The nodes and features that a visit leaves.
uvec2 count_left(Visit visit) { return uvec2(visit.node_count, bitCount(visit.bits.x) + bitCount(visit.bits.y)); }

// `at`: the positions of the first node and of the first feature.
void write_left(Visit visit, uvec2 at)
{
    for (uint i = 0; i < visit.node_count; ++i)
        nodes[at.x + i] = visit.nodes[i];
    for (uint i = 0; i < 2; ++i)
        for (uint bits = visit.bits[i]; bits != 0 && at.y < k_most_found; bits &= bits - 1)
            scratch[at.y++] = visit.firsts[i] + findLSB(bits);
}

// The root is visited here. That of a tree of one triangle is its leaf. All threads of the workgroup call it.
void start_traversal(FeatureTree tree, GroupBoxes boxes)
{
    barrier(); // all threads have read what the traversal before has found
    if (gl_LocalInvocationID.x == 0)
    {
        Visit visit = k_no_visit;
        if (tree.deforms)
            visit_padded(visit, 0, 0, Aim(tree, boxes, true));
        else
            leave_node(visit, 0);
        write_left(visit, uvec2(0));
        node_count = visit.node_count;
        found_count = count_left(visit).y;
    }
    barrier();
}

// How many of the nodes that wait are visited together. Each leaves two at most. The fuller the stack, the fewer, so that
// they get to leaves before it is full: nodes that are visited alone take as long as many. Where it is almost full, the last
// node is visited alone, and the stack grows by one node per level at most, as that of a single thread. So it never
// overflows.
uint visited_together(uint count, bool ordered)
{
    const uint room = k_most_nodes - VOILE_BVH_MAX_DEPTH;
    const uint threads = min(gl_WorkGroupSize.x, ordered ? k_ordered_nodes : gl_WorkGroupSize.x);
    return min(min(count, threads), count + 2 <= room ? (room - count) / 2 : 1);
}

// Nodes and features that the nodes before one of those in order leave. Without a loop, as Mesa ends those.
uvec2 left_before(uint visited)
{
    uvec2 sum = uvec2(0);
    [[unroll]] for (uint i = 0; i + 1 < k_ordered_nodes; ++i)
        sum += i < visited ? left_counts[i] : uvec2(0);
    return sum;
}

// Finds features until there are no more, or more than fit. `ordered`: in order, and until the list may be full. All threads
// of the workgroup call it.
void traverse(FeatureTree tree, GroupBoxes boxes, bool ordered)
{
    const uint thread = gl_LocalInvocationID.x;
    const uint most = ordered ? k_most_found - k_ordered_nodes * k_most_left : k_most_found;
    for (;;)
    {
        const uint count = node_count;
        const uint found = found_count;
        const uint visited = visited_together(count, ordered);
        const uint node = thread < visited ? nodes[count - 1 - thread] : 0;
        const bool looks = sweep_is_near == 0;
        barrier();
        if (count == 0 || found > most)
            return;
        if (thread == 0)
            node_count = count - visited;
        Visit visit = k_no_visit;
        if (thread < visited)
            visit = visit_children(node, Aim(tree, boxes, looks));
        if (ordered && thread < visited)
            left_counts[thread] = count_left(visit);
        barrier();
        if (thread < visited)
        {
            const uvec2 left = count_left(visit);
            uvec2 at = uvec2(atomicAdd(node_count, left.x), atomicAdd(found_count, left.y));
            if (ordered)
                at = uvec2(count - visited, found) + left_before(thread);
            write_left(visit, at);
        }
        barrier();
    }
}

// Sorts what was found. Without an order, threads would decide about that of the contacts of a vertex. Batcher 1968, "Sorting
// networks and their applications": a bitonic sort, as ranks take as many steps as there are features. All threads of the
// workgroup call it.
void sort_found()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint width = found_count > 1 ? 2u << findMSB(found_count - 1) : 1;
    for (uint i = found_count + thread; i < width; i += gl_WorkGroupSize.x)
        scratch[i] = VOILE_NO_VERTEX;
    barrier();
    for (uint run = 2; run <= width; run *= 2)
        for (uint apart = run / 2; apart > 0; apart /= 2)
        {
            for (uint pair = thread; pair < width / 2; pair += gl_WorkGroupSize.x)
            {
                const uint i = 2 * pair - (pair & (apart - 1));
                const uvec2 features = uvec2(scratch[i], scratch[i + apart]);
                const bool rising = (i & run) == 0;
                if (rising == (features.x > features.y))
                {
                    scratch[i] = features.y;
                    scratch[i + apart] = features.x;
                }
            }
            barrier();
        }
}

#endif
