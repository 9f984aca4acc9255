#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the pairs of near primitives of all cloths that collide with themselves and each other. A vertex searches for
// all primitives that it owns (wedges.glsl) at once, among those of its candidates that may be near (sift_candidates.comp).
// push.lanes neighboring threads share a search: VOILE_PAIR_WEDGE_LANES of them take a candidate, each some of its wedges.
//
// Vertices move along sweeps. A pair is listed if the distance of its sweeps is at most the range of the owner. A thread
// or a list that is full keeps the nearest pairs, and the range shrinks to the nearest pair that it leaves out. The owner
// of the other side decides for itself (match_pairs.comp).
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_wedges)) readonly buffer MeshWedges { MeshWedge mesh_wedges[]; };
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_references)) readonly buffer PairReferences { uint candidates[]; };
layout(VOILE_BINDING(pair_masks)) readonly buffer PairMasks { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(tangles)) readonly buffer Tangles { Tangle tangles[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) writeonly buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_lists)) buffer PairLists { PairList pair_lists[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/candidate_lists.glsl"
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

// A pair that a thread has found: which one of the search, and its distance. Its vertices would take twice the shared
// memory.
struct Found
{
    float distance; // m
    uint code;
};

const uint k_kinds = 8;

// Where a list is full, edges count as farther by this factor. Between layers that lie on each other, vertices and triangles
// carry the load. All pairs are equally near there, so that a list would keep any of them: what it left out sank until the
// next lists, was parted from what it had sunk towards, and layers bounced.
const float k_edges_later = 1.2;

float order_of(Found pair) { return pair.distance * (pair.code % k_kinds > k_own_triangle ? k_edges_later : 1); }

shared Found found[VOILE_PAIR_FOUND * gl_WorkGroupSize.x];
shared uint found_counts[gl_WorkGroupSize.x];
shared float found_ranges[gl_WorkGroupSize.x];
shared uint left_out[gl_WorkGroupSize.x]; // m, per search: the nearest pair for which the list has no room; the bits of a float

void insert(inout Search search, uint kind, uvec4 vertices, bool edges, float at)
{
    if (are_tangled(vertices, edges) || touch_at_start(search.fan, vertices, edges))
        return;
    const uint first = gl_LocalInvocationID.x * VOILE_PAIR_FOUND;
    const uint capacity = min(push.capacity, VOILE_PAIR_FOUND);
    const Found pair = Found(at, (search.combination * VOILE_PAIR_CANDIDATES + search.candidate) * k_kinds + kind);
    if (search.count < capacity)
    {
        found[first + search.count++] = pair;
        return;
    }
    uint slot = capacity;
    Found last = pair;
    for (uint k = 0; k < capacity; ++k)
        if (order_of(found[first + k]) > order_of(last))
        {
            last = found[first + k];
            slot = k;
        }
    search.range = min(search.range, last.distance);
    if (slot < capacity)
        found[first + slot] = pair;
}

bool goes_on(Search search) { return true; }

uint candidate_at(Search search, uint place) { return candidates[candidate_place(search.fan.center, 0, place)]; }

Pair pair_of(Search search, uint code)
{
    const uint kind = code % k_kinds;
    const uint combination = code / (k_kinds * VOILE_PAIR_CANDIDATES);
    const uint other = candidate_at(search, code / k_kinds % VOILE_PAIR_CANDIDATES);
    const Wedge own = wedge_of(search.fan, combination % search.fan.wedges);
    const Wedge wedge = wedge_of(fan_of(pair_lists[other].cloth, other), combination / search.fan.wedges);
    if (kind == k_own_vertex)
        return Pair(ordered_triangle(search.fan.center, uvec3(other, wedge.b, wedge.c)), false);
    if (kind == k_own_triangle)
        return Pair(ordered_triangle(other, uvec3(search.fan.center, own.b, own.c)), false);
    const uvec2 a = uvec2(search.fan.center, (kind & 1u) == 0 ? own.b : own.c);
    const uvec2 b = uvec2(other, (kind & 2u) == 0 ? wedge.b : wedge.c);
    return Pair(ordered_edges(a, b), true);
}

void search_candidates(inout Search search, uint lane, uint lengths)
{
    const uint lists = max(push.lanes / VOILE_PAIR_WEDGE_LANES, 1); // at a time
    for (uint list = lane / VOILE_PAIR_WEDGE_LANES; list < VOILE_PAIR_LEAF; list += lists)
    {
        for (uint k = 0; k < length_of(lengths, list); ++k)
        {
            search.candidate = candidate_place(0, list, k);
            const uint other = candidate_at(search, search.candidate);
            if ((other & VOILE_PAIR_FAR_BIT) == 0)
                consider_fan(search, fan_of(pair_lists[other].cloth, other));
        }
    }
}

// The place of a pair among all that the threads of its search have found: the nearest is first, so that the order does
// not depend on timing.
uint rank_of(Found pair, uint first_thread)
{
    uint rank = 0;
    for (uint thread = first_thread; thread < first_thread + push.lanes; ++thread)
        for (uint k = 0; k < found_counts[thread]; ++k)
        {
            const Found other = found[thread * VOILE_PAIR_FOUND + k];
            if (order_of(other) < order_of(pair) || (order_of(other) == order_of(pair) && other.code < pair.code))
                ++rank;
        }
    return rank;
}

// Lists what the thread has found.
void list_found(Search search, uint thread, uint first_thread)
{
    for (uint k = 0; k < search.count; ++k)
    {
        const Found pair = found[thread * VOILE_PAIR_FOUND + k];
        const uint rank = rank_of(pair, first_thread);
        if (rank >= push.capacity)
        {
            atomicMin(left_out[first_thread], floatBitsToUint(pair.distance));
            continue;
        }
        const uint entry = search.fan.center * VOILE_PAIRS + rank;
        pairs[entry] = packed(pair_of(search, pair.code));
        pair_distances[entry] = pair.distance;
    }
}

// By the first thread of the search.
void end_list(uint vertex, uint thread)
{
    uint count = 0;
    float range = uintBitsToFloat(left_out[thread]);
    for (uint k = thread; k < thread + push.lanes; ++k)
    {
        count += found_counts[k];
        range = min(range, found_ranges[k]);
    }
    pair_lists[vertex].range = range;
    pair_lists[vertex].count = min(count, push.capacity);
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint lane = thread % push.lanes;
    const uint place = gl_GlobalInvocationID.x / push.lanes;
    const uint entries = pair_passes[VOILE_PAIR_FIND].entries;
    if (place - thread / push.lanes >= entries) // of the first thread of the workgroup
        return;
    const bool searches = place < entries;
    const uint vertex = searches ? searching_vertices[place] : 0;
    Search search;
    search.range = k_unbounded_range;
    search.count = 0;
    if (searches)
    {
        const PairList list = pair_lists[vertex];
        search = search_of(vertex, list, lane % VOILE_PAIR_WEDGE_LANES, min(push.lanes, VOILE_PAIR_WEDGE_LANES));
        search_candidates(search, lane, list.mask);
    }
    found_counts[thread] = search.count;
    found_ranges[thread] = search.range;
    left_out[thread] = floatBitsToUint(k_unbounded_range);
    barrier();
    list_found(search, thread, thread - lane);
    barrier();
    if (searches && lane == 0)
        end_list(vertex, thread);
}
