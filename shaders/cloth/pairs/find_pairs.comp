#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the pairs of near primitives of all cloths that collide with themselves and each other. A vertex searches for
// all primitives that it owns (fan.glsl) at once, among those of its candidates that may be near (sift_candidates.comp).
// push.lanes neighboring threads share a search: each tests a part of the wedges and fills a part of the list.
//
// Vertices move along sweeps. A pair is listed if the distance of its sweeps is at most the range of the owner. A list
// that is full keeps the nearest pairs, and the range shrinks to the nearest pair that it leaves out. The owner of the
// other side decides for itself (match_pairs.comp).
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_references)) readonly buffer PairReferences { uint candidates[]; };
layout(VOILE_BINDING(pair_masks)) readonly buffer PairMasks { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(tangles)) readonly buffer Tangles { Tangle tangles[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_lists)) buffer PairLists { PairList pair_lists[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/search.glsl"

const float k_unbounded_range = 1e30;
// Of the size of a pair: parts nearer than this touch.
const float k_touch = 1e-7;

// Whether parts of a mesh touch where it starts, as along a seam that is not merged. No plane separates them, so they are
// no pair: it would hold both in place. Both owners find the same. Grids start flat.
bool touch_at_start(Fan fan, uvec4 vertices, bool edges)
{
    if (fan.columns > 0 || pair_lists[vertices.x].cloth != pair_lists[vertices.w].cloth)
        return false;
    vec3 x[4];
    float size = 0;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        x[k] = start[vertices[k]].xyz - start[vertices.x].xyz;
        size = max(size, length(x[k]));
    }
    return length(nearest_points(edges, x).apart) <= k_touch * size;
}

// Cloth that is tangled passes through what is tangled on its way out (find_tangles.comp). All other cloth holds it.
bool are_tangled(uvec4 vertices, bool edges)
{
    const bvec4 tangled = bvec4(tangles[vertices.x].pairs != 0, tangles[vertices.y].pairs != 0,
                                tangles[vertices.z].pairs != 0, tangles[vertices.w].pairs != 0);
    return (tangled.x || (edges && tangled.y)) && ((!edges && tangled.y) || tangled.z || tangled.w);
}

void insert(inout Search search, uvec4 vertices, bool edges, float at)
{
    if (are_tangled(vertices, edges) || touch_at_start(search.fan, vertices, edges))
        return;
    const uint part = VOILE_PAIRS / search.lanes;
    const uint first = search.fan.center * VOILE_PAIRS + search.lane * part;
    const uint capacity = max(push.capacity / search.lanes, 1);
    uint place = search.count;
    if (search.count < capacity)
        ++search.count;
    else
    {
        float farthest = at;
        for (uint k = 0; k < capacity; ++k)
            if (pair_distances[first + k] > farthest)
            {
                farthest = pair_distances[first + k];
                place = k;
            }
        search.range = min(search.range, farthest);
        if (place == capacity)
            return;
    }
    pairs[first + place] = packed(Pair(vertices, edges));
    pair_distances[first + place] = at;
}

shared float shared_ranges[gl_WorkGroupSize.x];
shared uint shared_counts[gl_WorkGroupSize.x];

bool goes_on(Search search) { return true; }

// What all threads of a search have found, in the first of them: the smallest range, and the lengths of their parts.
PairList merged_list(uint thread, Search search, PairList list)
{
    shared_ranges[thread] = search.range;
    shared_counts[thread] = search.count;
    barrier();
    list.counts = search.count;
    list.range = search.range;
    if (search.lane == 0)
        for (uint k = 1; k < search.lanes; ++k)
        {
            list.range = min(list.range, shared_ranges[thread + k]);
            list.counts |= shared_counts[thread + k] << (k * VOILE_PAIR_COUNT_BITS);
        }
    return list;
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint place = gl_GlobalInvocationID.x / push.lanes;
    const bool searches = place < pair_passes[VOILE_PAIR_FIND].entries;
    Search search;
    search.lane = thread % push.lanes;
    search.lanes = push.lanes;
    search.range = k_unbounded_range;
    search.count = 0;
    uint vertex = 0;
    PairList list = PairList(0, 0, 0, 0);
    if (searches)
    {
        vertex = searching_vertices[place];
        list = pair_lists[vertex];
        search = search_of(vertex, list, search.lane, push.lanes);
        for (uint k = 0; k < (list.mask & VOILE_PAIR_CANDIDATE_MASK); ++k)
        {
            const uint other = candidates[vertex * VOILE_PAIR_CANDIDATES + k];
            if ((other & VOILE_PAIR_FAR_BIT) == 0)
                consider_fan(search, fan_of(pair_lists[other].cloth, other));
        }
    }
    list = merged_list(thread, search, list);
    if (!searches || search.lane != 0)
        return;
    pair_lists[vertex].range = list.range;
    pair_lists[vertex].counts = list.counts;
}
