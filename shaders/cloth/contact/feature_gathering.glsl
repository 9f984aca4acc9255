// The features near the vertices of a workgroup, in shared memory, a chunk after the other. Each thread tests its pieces of
// cloth against a chunk before the next one is loaded. What is in a chunk depends on no order of threads.
//
// The including kernel declares what feature_traversal.glsl and near_feature.glsl need, and includes the latter before.
#ifndef VOILE_FEATURE_GATHERING_GLSL
#define VOILE_FEATURE_GATHERING_GLSL

#include "contact/feature_traversal.glsl"

const uint k_most_loaded = 182; // features, in shared memory with their positions

// Features of a collider that are in shared memory.
struct Chunk
{
    uint first;
    uint end;
    bool all; // that are near; else they have a box
};

shared uint loaded[k_most_loaded];              // in the order of the features, collider by collider
shared vec4 loaded_starts[k_most_loaded];       // a, radius
shared float loaded_ends[3 * k_most_loaded];    // b
shared float loaded_motions[6 * k_most_loaded]; // of a and of b until the next query, in the collider's space

// The features of the first colliders stay loaded, if those of all fit.
const uint k_most_kept = 8;
shared uint kept_ends[k_most_kept]; // of their chunks, which follow each other
shared uint keeps;                  // 0: they do not

void load_feature(uint at, uint feature, NearFeature near)
{
    loaded[at] = feature;
    loaded_starts[at] = near.a;
    for (uint axis = 0; axis < 3; ++axis)
    {
        loaded_ends[3 * at + axis] = near.b[axis];
        loaded_motions[6 * at + axis] = near.motion_a[axis];
        loaded_motions[6 * at + 3 + axis] = near.motion_b[axis];
    }
}

vec3 loaded_motion(uint first)
{
    return vec3(loaded_motions[first], loaded_motions[first + 1], loaded_motions[first + 2]);
}

NearFeature loaded_feature(uint i)
{
    return NearFeature(loaded_starts[i], vec3(loaded_ends[3 * i], loaded_ends[3 * i + 1], loaded_ends[3 * i + 2]),
                       loaded_motion(6 * i), loaded_motion(6 * i + 3));
}

Box swept_box(NearFeature near)
{
    return grown(joined(box_around(near.a.xyz, near.b),
                        box_around(near.a.xyz + near.motion_a, near.b + near.motion_b)), near.a.w);
}

Box chunk_box()
{
    Box result;
    for (int axis = 0; axis < 3; ++axis)
    {
        result.min[axis] = from_ordered(corners[k_chunk_corners + axis]);
        result.max[axis] = from_ordered(corners[k_chunk_corners + 3 + axis]);
    }
    return result;
}

// Loads features that were found, from the `rank`-th on. All threads of the workgroup call it.
void load_chunk(Chunk chunk, FeatureTree tree, uint rank)
{
    const uint thread = gl_LocalInvocationID.x;
    if (!chunk.all)
    {
        barrier(); // all threads have read the chunk before
        for (uint i = thread; i < 6; i += gl_WorkGroupSize.x)
            corners[k_chunk_corners + i] = ordered(i < 3 ? 3e38 : -3e38);
        barrier();
    }
    for (uint i = chunk.first + thread; i < chunk.end; i += gl_WorkGroupSize.x)
    {
        const uint feature = scratch[rank + i - chunk.first];
        const NearFeature near = near_feature(tree.collider, feature, tree.deforms);
        load_feature(i, feature, near);
        if (!chunk.all)
            join_corners(k_chunk_corners, swept_box(near));
    }
    barrier();
}

// The features of a collider near a workgroup, a chunk after the other.
struct Chunks
{
    uint rank;    // of the next chunk's first feature, in what was found
    bool started;
    bool ordered; // there are more than the list has room for
    bool ended;
};

// Finds the next features. All threads of the workgroup call it.
void find_features(inout Chunks chunks, FeatureTree tree, GroupBoxes boxes)
{
    bool starts = !chunks.started;
    chunks.started = true;
    if (!starts)
    {
        barrier(); // all threads have read the count
        if (gl_LocalInvocationID.x == 0)
            found_count = 0;
        barrier();
    }
    for (;;)
    {
        if (starts)
            start_traversal(tree, boxes);
        traverse(tree, boxes, chunks.ordered);
        if (found_count <= k_most_found)
            break;
        starts = chunks.ordered = true;
    }
    if (!chunks.ordered)
        sort_found();
}

// The next chunk, which may be empty. If it has all features, it is at `first`. All threads of the workgroup call it.
Chunk next_chunk(inout Chunks chunks, FeatureTree tree, GroupBoxes boxes, uint first)
{
    if (chunks.rank == 0)
        find_features(chunks, tree, boxes);
    Chunk chunk = Chunk(first, first + found_count, true);
    if (chunk.end > k_most_loaded || chunks.ordered)
        chunk = Chunk(0, min(found_count - chunks.rank, k_most_loaded), false);
    load_chunk(chunk, tree, chunks.rank);
    chunks.rank += chunk.end - chunk.first;
    const bool empty = chunks.rank >= found_count;
    chunks.ended = empty && (!chunks.ordered || node_count == 0);
    chunks.rank = empty ? 0 : chunks.rank;
    return chunk;
}

// Notes that the features of the `index`-th collider stay loaded, or that there is no room for those of all.
void keep(Chunk chunk, uint index)
{
    if (gl_LocalInvocationID.x != 0)
        return;
    if (chunk.all && index < k_most_kept)
        kept_ends[index] = chunk.end;
    else
        keeps = 0;
}

// Where the features of the `index`-th collider begin.
uint first_kept(uint index) { return keeps == 0 || index == 0 ? 0 : kept_ends[min(index, k_most_kept) - 1]; }

#endif
