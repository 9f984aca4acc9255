// The features near the vertices of a workgroup.
//
// Its threads traverse a hierarchy together, one level at a time. Then each tests its pieces of cloth against what they
// found, from shared memory. A thread that traverses alone waits for memory at every node, and where features are dense
// the whole dispatch waits for that thread.
//
// The including kernel declares bvh_nodes[], features[], feature_slots[], padded_boxes[] and push (NearFeaturesPush), and
// includes box.glsl, padded.glsl and near_feature.glsl before.
#ifndef VOILE_FEATURE_GATHERING_GLSL
#define VOILE_FEATURE_GATHERING_GLSL

const uint k_most_gathered = 128;  // features, of all colliders together
const uint k_most_nodes = 128;     // of a level
const uint k_most_gatherings = 8;  // colliders

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
shared vec4 gathered_starts[k_most_gathered]; // a, radius
shared vec4 gathered_ends[k_most_gathered];
shared vec4 gathered_motions[2 * k_most_gathered]; // of a and of b until the next query, in the collider's space
shared uint found_features[k_most_gathered]; // of one collider, in no order
shared uint found_count;
shared uint level_nodes[2 * k_most_nodes];
shared uint level_counts[2];
shared uint sweep_is_near;
shared uint is_crowded;
shared uint corners[12]; // of two boxes, minima and maxima, as numbers in the order of the floats

uint ordered(float x)
{
    const uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

float from_ordered(uint x) { return uintBitsToFloat((x & 0x80000000u) != 0 ? x & 0x7fffffffu : ~x); }

// Of a workgroup, in the space of a collider.
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
        result.min[axis] = from_ordered(corners[first + axis]);
        result.max[axis] = from_ordered(corners[first + 3 + axis]);
    }
    return result;
}

// The unions of the boxes of the threads that `have` them. Those that are not finite are left out. All threads of the
// workgroup call it.
GroupBoxes joined_of_group(bool have, GroupBoxes own)
{
    barrier();
    for (uint i = gl_LocalInvocationID.x; i < 12; i += gl_WorkGroupSize.x)
        corners[i] = ordered(i % 6 < 3 ? 3e38 : -3e38);
    barrier();
    if (have && is_finite(own.pieces) && is_finite(own.sweep))
    {
        join_corners(0, own.pieces);
        join_corners(6, own.sweep);
    }
    barrier();
    return GroupBoxes(joined_corners(0), joined_corners(6));
}

void add_leaf(uint leaf, uint first_feature)
{
    const uint first = first_feature + (leaf & VOILE_BVH_FIRST_MASK);
    const uint count = (leaf >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK) + 1;
    const uint at = atomicAdd(found_count, count);
    if (at + count > k_most_gathered)
    {
        is_crowded = 1;
        return;
    }
    for (uint i = 0; i < count; ++i)
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
        else
            is_crowded = 1;
    }
}

void add_node(uint node, uint level)
{
    const uint at = atomicAdd(level_counts[level], 1);
    if (at < k_most_nodes)
        level_nodes[level * k_most_nodes + at] = node;
    else
        is_crowded = 1;
}

// Notes whether a feature is in the sweep. Returns whether the children of a node must be visited.
//
// `looks`: none is known to be. A node that overlaps the sweep and is small has one near it.
bool visit_box(Box box, GroupBoxes boxes, bool looks, bool is_leaf)
{
    const float coarse = sudden_reach();
    bool in_sweep = looks && overlap(boxes.sweep, box);
    const vec3 size = box.max - box.min;
    if (in_sweep && (is_leaf || max(max(size.x, size.y), size.z) <= coarse))
    {
        sweep_is_near = 1;
        in_sweep = false;
    }
    return !is_leaf && (overlap(boxes.pieces, box) || in_sweep);
}

void visit_child(uint child, Box box, GroupBoxes boxes, bool looks, uint first_feature, uint next_level)
{
    const bool is_leaf = (child & VOILE_BVH_LEAF_BIT) != 0;
    if (visit_box(box, boxes, looks, is_leaf))
        add_node(child, next_level);
    if (is_leaf && overlap(boxes.pieces, box))
        add_leaf(child, first_feature);
}

// The tree of a mesh that deforms (padded_layout.h).
struct PaddedSearch
{
    DeformingSet set;
    uint first_box;
    uint first_slot;
    uint triangles;
};

// `width`: the number of boxes on the level of `index`.
void visit_padded(uint index, uint width, PaddedSearch search, GroupBoxes boxes, bool looks, uint next_level)
{
    const bool is_leaf = width >= search.triangles; // the last level
    if (is_leaf && index >= search.triangles)
        return; // repeats another slot
    const Box box = padded_box(search.first_box + width - 1 + index);
    if (visit_box(box, boxes, looks, is_leaf))
        add_node(index, next_level);
    if (is_leaf && overlap(boxes.pieces, box))
        add_slot(search.first_slot + index, search.set);
}

// A tree of one triangle has one level, its root, which is its leaf.
void gather_padded(GroupBoxes boxes, PaddedSearch search)
{
    const uint thread = gl_LocalInvocationID.x;
    if (thread == 0)
    {
        found_count = sweep_is_near = is_crowded = 0;
        level_counts[0] = level_counts[1] = 0;
    }
    barrier();
    if (thread == 0)
        visit_padded(0, 1, search, boxes, true, 0);
    barrier();
    uint level = 0;
    for (uint width = 1; width < search.triangles; width *= 2)
    {
        const uint count = level_counts[level];
        const bool looks = sweep_is_near == 0;
        const bool crowded = is_crowded != 0;
        barrier();
        if (count == 0 || crowded)
            return;
        if (thread == 0)
            level_counts[1 - level] = 0;
        barrier();
        for (uint i = thread; i < count; i += gl_WorkGroupSize.x)
        {
            const uint node = level_nodes[level * k_most_nodes + i];
            visit_padded(node, 2 * width, search, boxes, looks, 1 - level);
            visit_padded(node + width, 2 * width, search, boxes, looks, 1 - level);
        }
        barrier();
        level = 1 - level;
    }
}

void gather_levels(GroupBoxes boxes, uint first_node, uint first_feature)
{
    const uint thread = gl_LocalInvocationID.x;
    if (thread == 0)
    {
        found_count = sweep_is_near = is_crowded = 0;
        level_counts[0] = 1;
        level_nodes[0] = 0;
    }
    barrier();
    for (uint level = 0;; level = 1 - level)
    {
        const uint count = level_counts[level];
        const bool looks = sweep_is_near == 0;
        const bool crowded = is_crowded != 0;
        if (thread == 0)
            level_counts[1 - level] = 0;
        barrier();
        if (count == 0 || crowded)
            return;
        for (uint i = thread; i < count; i += gl_WorkGroupSize.x)
        {
            const BvhNode n = bvh_nodes[first_node + level_nodes[level * k_most_nodes + i]];
            visit_child(n.left, Box(n.left_min, n.left_max), boxes, looks, first_feature, 1 - level);
            visit_child(n.right, Box(n.right_min, n.right_max), boxes, looks, first_feature, 1 - level);
        }
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
        gathered_ends[rank] = vec4(near.b, 0);
        gathered_motions[2 * rank] = vec4(near.motion_a, 0);
        gathered_motions[2 * rank + 1] = vec4(near.motion_b, 0);
    }
}

// Of the features that a workgroup has gathered.
NearFeature gathered_feature(uint i)
{
    return NearFeature(gathered_starts[i], gathered_ends[i].xyz, gathered_motions[2 * i].xyz,
                       gathered_motions[2 * i + 1].xyz);
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
        if (deforms)
            gather_padded(boxes, PaddedSearch(deforming_set(c), colliders[c].first_node, set.first_node,
                                              colliders[c].triangles));
        else
            gather_levels(boxes, set.first_node, set.first_feature);
        result.crowded = is_crowded != 0 || first + found_count > k_most_gathered;
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
