// The features near the vertices of a workgroup.
//
// Its threads traverse a hierarchy together, one node each at a time. Then each tests its pieces of cloth against what they
// found, from shared memory. A thread that traverses alone waits for memory at every node, and where features are dense
// the whole dispatch waits for that thread.
//
// Vertices that follow each other need not be close: those of a skirt make an arc that a leg is in. So they are divided into
// parts, and a node is visited if it is near one of these.
//
// The including kernel declares bvh_nodes[], features[], feature_slots[], padded_boxes[] and push (NearFeaturesPush), and
// includes box.glsl, padded_box.glsl and near_feature.glsl before.
#ifndef VOILE_FEATURE_GATHERING_GLSL
#define VOILE_FEATURE_GATHERING_GLSL

#include "shared/ordered.glsl"

const uint k_most_gathered = 184; // features, of all colliders together
const uint k_most_nodes = 256;    // that wait to be visited
const uint k_most_gatherings = 8; // colliders
const uint k_parts = 16;          // of the workgroup's vertices, each with boxes of its own

// What is near of one collider: a range of the gathered features.
struct Gathering
{
    uint first;
    uint end;
    bool crowded; // there are more than fit: each thread traverses alone
    bool near;    // a feature may be in the sweep
};

shared Gathering gatherings[k_most_gatherings];
shared uint gathered[k_most_gathered];       // in the order of the features, collider by collider
shared vec4 gathered_starts[k_most_gathered];      // a, radius
shared float gathered_ends[3 * k_most_gathered];    // b
shared float gathered_motions[6 * k_most_gathered]; // of a and of b until the next query, in the collider's space
shared uint found_features[k_most_gathered]; // of one collider, in no order
shared uint found_count;
shared uint nodes[k_most_nodes]; // that wait, a stack
shared uint node_count;
shared uint sweep_is_near;
shared uint corners[12 * (k_parts + 1)]; // minima and maxima of the two boxes of each part, at the end of all; as floats

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
    for (uint i = thread; i < corners.length(); i += gl_WorkGroupSize.x)
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
    for (uint i = thread; i < corners.length(); i += gl_WorkGroupSize.x)
        corners[i] = floatBitsToUint(from_ordered(corners[i]));
    barrier();
    return GroupBoxes(joined_corners(all_parts), joined_corners(all_parts + 6));
}

// Whether a node overlaps one of the parts' boxes. `all`: their union. `first`: the corners of the first one.
bool is_near_part(Box all, uint first, Box node)
{
    bool result = false;
    if (overlap(all, node))
        for (uint part = 0; part < k_parts && !result; ++part)
            result = overlap(joined_corners(12 * part + first), node);
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

void add_leaf(uint leaf, uint first_feature)
{
    const uint first = first_feature + (leaf & VOILE_BVH_FIRST_MASK);
    const uint count = (leaf >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK) + 1;
    const uint at = atomicAdd(found_count, count);
    for (uint i = 0; i < count && at + i < k_most_gathered; ++i)
        found_features[at + i] = first + i;
}

// Of a mesh that deforms: those that protrude.
void add_slot(uint slot, DeformingSet set)
{
    const uint first = feature_slots[slot] >> VOILE_SLOT_FEATURE_BITS;
    const uint count = feature_slots[slot] & ((1u << VOILE_SLOT_FEATURE_BITS) - 1);
    for (uint f = first; f < first + count; ++f)
    {
        if (!protrudes(set, f))
            continue;
        const uint at = atomicAdd(found_count, 1);
        if (at < k_most_gathered)
            found_features[at] = f;
    }
}

// Notes whether a feature is in the sweep. Returns whether the children of a node must be visited.
//
// `looks`: none is known to be. A node that overlaps the sweep and is small has one near it.
bool visit_box(Box box, GroupBoxes boxes, bool looks, bool is_leaf)
{
    const float coarse = sudden_reach();
    bool in_sweep = looks && is_near_sweep(boxes, box);
    const vec3 size = box.max - box.min;
    if (in_sweep && (is_leaf || max(max(size.x, size.y), size.z) <= coarse))
    {
        sweep_is_near = 1;
        in_sweep = false;
    }
    return !is_leaf && (in_sweep || is_near_pieces(boxes, box));
}

void visit_child(uint child, Box box, FeatureTree tree, GroupBoxes boxes, bool looks)
{
    const bool is_leaf = (child & VOILE_BVH_LEAF_BIT) != 0;
    if (visit_box(box, boxes, looks, is_leaf))
        nodes[atomicAdd(node_count, 1)] = child;
    if (is_leaf && is_near_pieces(boxes, box))
        add_leaf(child, tree.first_leaf);
}

uint padded_width(uint node) { return 1u << findMSB(node + 1); }

// `node`: its index in the tree.
void visit_padded(uint node, FeatureTree tree, GroupBoxes boxes, bool looks)
{
    const uint width = padded_width(node);
    const uint index = node + 1 - width;
    const bool is_leaf = width >= tree.triangles; // the last level
    if (is_leaf && index >= tree.triangles)
        return; // repeats another slot
    const Box box = padded_box(tree.first_node + node);
    if (visit_box(box, boxes, looks, is_leaf))
        nodes[atomicAdd(node_count, 1)] = node;
    if (is_leaf && is_near_pieces(boxes, box))
        add_slot(tree.first_leaf + index, deforming_set(tree.collider));
}

void visit_children(uint node, FeatureTree tree, GroupBoxes boxes, bool looks)
{
    if (tree.deforms)
    {
        const uint width = padded_width(node);
        visit_padded(node + width, tree, boxes, looks);
        visit_padded(node + 2 * width, tree, boxes, looks);
        return;
    }
    const BvhNode n = bvh_nodes[tree.first_node + node];
    visit_child(n.left, Box(n.left_min, n.left_max), tree, boxes, looks);
    visit_child(n.right, Box(n.right_min, n.right_max), tree, boxes, looks);
}

// The root is visited here. That of a tree of one triangle is its leaf.
void start_gathering(FeatureTree tree, GroupBoxes boxes)
{
    if (gl_LocalInvocationID.x == 0)
    {
        found_count = sweep_is_near = 0;
        node_count = tree.deforms ? 0 : 1;
        nodes[0] = 0;
        if (tree.deforms)
            visit_padded(0, tree, boxes, true);
    }
    barrier();
}

// How many of the nodes that wait are visited together. Each leaves two at most. Where the stack is almost full, the last
// node is visited alone, and the stack grows by one node per level at most, as that of a single thread. So it never
// overflows.
uint visited_together(uint count)
{
    const uint room = k_most_nodes - VOILE_BVH_MAX_DEPTH;
    return min(min(count, gl_WorkGroupSize.x), count < room ? room - count : 1);
}

// Ends early where there are more features than fit.
void gather_features(FeatureTree tree, GroupBoxes boxes)
{
    const uint thread = gl_LocalInvocationID.x;
    start_gathering(tree, boxes);
    for (;;)
    {
        const uint count = node_count;
        const uint visited = visited_together(count);
        const uint node = thread < visited ? nodes[count - 1 - thread] : 0;
        const bool looks = sweep_is_near == 0;
        const bool ends = count == 0 || found_count > k_most_gathered;
        barrier();
        if (ends)
            return;
        if (thread == 0)
            node_count = count - visited;
        barrier();
        if (thread < visited)
            visit_children(node, tree, boxes, looks);
        barrier();
    }
}

// Sorts what was found behind the features of the colliders before. Without an order, threads would decide about that
// of the contacts of a vertex.
void sort_features(uint first, uint c, bool deforms)
{
    for (uint i = gl_LocalInvocationID.x; i < found_count; i += gl_WorkGroupSize.x)
    {
        const uint feature = found_features[i];
        uint rank = first;
        for (uint j = 0; j < found_count; ++j)
            rank += found_features[j] < feature ? 1 : 0;
        gathered[rank] = feature;
        const NearFeature near = near_feature(c, feature, deforms);
        gathered_starts[rank] = near.a;
        for (uint axis = 0; axis < 3; ++axis)
        {
            gathered_ends[3 * rank + axis] = near.b[axis];
            gathered_motions[6 * rank + axis] = near.motion_a[axis];
            gathered_motions[6 * rank + 3 + axis] = near.motion_b[axis];
        }
    }
}

vec3 gathered_motion(uint first)
{
    return vec3(gathered_motions[first], gathered_motions[first + 1], gathered_motions[first + 2]);
}

// Of the features that a workgroup has gathered.
NearFeature gathered_feature(uint i)
{
    return NearFeature(gathered_starts[i], vec3(gathered_ends[3 * i], gathered_ends[3 * i + 1], gathered_ends[3 * i + 2]),
                       gathered_motion(6 * i), gathered_motion(6 * i + 3));
}

// Gathers the features of the `index`-th collider near the workgroup. All of its threads call it.
Gathering gather(uint index, GroupBoxes boxes, uint c, FeatureSet set, bool deforms)
{
    if (index >= k_most_gatherings)
        return Gathering(0, 0, true, true);
    const uint first = index == 0 ? 0 : gatherings[index - 1].end;
    Gathering result = Gathering(first, first, false, false);
    if (all(lessThanEqual(boxes.sweep.min, boxes.sweep.max))) // else no vertex is near
    {
        gather_features(feature_tree(c, set, deforms), boxes);
        result.crowded = first + found_count > k_most_gathered;
        result.near = result.crowded || sweep_is_near != 0;
        if (!result.crowded)
        {
            result.end += found_count;
            sort_features(first, c, deforms);
        }
    }
    if (gl_LocalInvocationID.x == 0)
        gatherings[index] = result;
    barrier();
    return result;
}

#endif
