#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the pairs of near primitives of all cloths that collide with themselves and each other. A vertex searches for
// all primitives that it owns (fan.glsl) at once, among those of its candidates (find_candidates.comp). push.lanes
// neighboring threads share a search: each tests a part of the wedges and fills a part of the list.
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
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_references)) readonly buffer PairReferences { uint candidates[]; };
layout(VOILE_BINDING(pair_entries)) readonly buffer PairEntries { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_lists)) buffer PairLists { PairList pair_lists[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "contact/rounding.glsl"
#include "shared/box.glsl"
#include "pairs/fan.glsl"
#include "pairs/node.glsl"
#include "pairs/pair.glsl"

// A wedge with its vertices, as the search sees them. A spoke that the fan does not own repeats the center. Spheres are
// around a primitive with its sweeps: the middle and the radius.
struct Piece
{
    Node a; // the center
    Node b;
    Node c;
    Wedge wedge;
    Box box;
    vec4 edge_b;
    vec4 edge_c;
    vec4 triangle;
};

// The search of a vertex, and the list that it fills.
struct Search
{
    Fan fan;
    Viewpoint from; // the middle of the vertex's sweep, carried as the vertex is
    float range;
    float rounding; // m, of positions near it
    uint count;
    uint lane;
    uint lanes;
    uint own_wedge; // its piece is in `own`
    Piece own;
};

const float k_unbounded_range = 1e30;

// Rounding of spheres, as a part of their radii.
const float k_sphere_rounding = 1e-5;

Box around(Node node) { return Box(node.x - extent_of(node), node.x + extent_of(node)); }

// m: how far the vertex may be from its middle.
float reach_of(Node node) { return length(node.sweep) + length(node.carry); }

vec4 sphere_around(Node a, Node b)
{
    return vec4(0.5 * (a.x + b.x), 0.5 * distance(a.x, b.x) + max(reach_of(a), reach_of(b)));
}

vec4 sphere_around(Node a, Node b, Node c)
{
    const vec3 middle = (a.x + b.x + c.x) / 3;
    const vec3 radii = vec3(distance(middle, a.x), distance(middle, b.x), distance(middle, c.x));
    return vec4(middle, max(radii.x, max(radii.y, radii.z)) +
                            max(reach_of(a), max(reach_of(b), reach_of(c))));
}

Piece piece_of(Search search, Fan fan, uint k)
{
    Piece piece;
    piece.wedge = wedge_of(fan, k);
    piece.a = node_of(fan.center, search.from);
    piece.b = piece.wedge.triangle || piece.wedge.edge_b ? node_of(piece.wedge.b, search.from) : piece.a;
    piece.c = piece.wedge.triangle || piece.wedge.edge_c ? node_of(piece.wedge.c, search.from) : piece.a;
    piece.box = joined(around(piece.a), joined(around(piece.b), around(piece.c)));
    piece.edge_b = sphere_around(piece.a, piece.b);
    piece.edge_c = sphere_around(piece.a, piece.c);
    piece.triangle = sphere_around(piece.a, piece.b, piece.c);
    return piece;
}

void insert(inout Search search, uvec4 vertices, bool edges, float at)
{
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

// m: between both sides along a direction, `heights` and `sweeps`: of the vertices along it.
float gap_between(bool edges, vec4 heights, vec4 sweeps)
{
    const vec4 low = heights - sweeps;
    const vec4 high = heights + sweeps;
    return (edges ? min(low.x, low.y) : low.x) - (edges ? max(high.z, high.w) : max(high.y, max(high.z, high.w)));
}

// m: a lower bound of the distance of both sides along their sweeps. Both are convex, so any direction gives one. This
// one is that of the nearest points of the middles. A sweep across it costs nothing, nor does what carries both. The
// gap is concave in the time of the clock, so that it is least at one end.
float distance_of(Search search, bool edges, Node nodes[4])
{
    const vec3 x[4] = vec3[](nodes[0].x, nodes[1].x, nodes[2].x, nodes[3].x);
    const vec3 apart = nearest_points(edges, x).apart;
    const vec3 n = apart / max(length(apart), 1e-20);
    vec4 heights;
    vec4 sweeps;
    vec4 carries;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        heights[k] = dot(n, x[k] - x[0]);
        sweeps[k] = abs(dot(n, nodes[k].sweep));
        carries[k] = dot(n, nodes[k].carry);
    }
    return min(gap_between(edges, heights - carries, sweeps), gap_between(edges, heights + carries, sweeps)) -
           search.rounding;
}

// False: the distance is more than the range.
bool are_near(Search search, vec4 a, vec4 b)
{
    const vec3 apart = a.xyz - b.xyz;
    const float near = (a.w + b.w) * (1 + k_sphere_rounding) + search.range + search.rounding;
    return dot(apart, apart) <= near * near;
}

void consider_triangle(inout Search search, Node v, Piece piece)
{
    if (!piece.wedge.triangle || !are_near(search, vec4(v.x, reach_of(v)), piece.triangle) ||
        v.vertex == piece.a.vertex || v.vertex == piece.b.vertex || v.vertex == piece.c.vertex)
        return;
    const float at = distance_of(search, false, Node[](v, piece.a, piece.b, piece.c));
    if (at <= search.range)
        insert(search, ordered_triangle(v.vertex, uvec3(piece.a.vertex, piece.b.vertex, piece.c.vertex)), false, at);
}

void consider_edges(inout Search search, Node a, Node b, Node c, Node d)
{
    if (a.vertex == c.vertex || a.vertex == d.vertex || b.vertex == c.vertex || b.vertex == d.vertex)
        return;
    const float at = distance_of(search, true, Node[](a, b, c, d));
    if (at <= search.range)
        insert(search, ordered_edges(uvec2(a.vertex, b.vertex), uvec2(c.vertex, d.vertex)), true, at);
}

void consider_spokes(inout Search search, Piece own, Piece piece)
{
    for (uint k = 0; k < 4; ++k)
    {
        const bool first = (k & 1u) == 0;
        const bool second = (k & 2u) == 0;
        if ((first ? own.wedge.edge_b : own.wedge.edge_c) && (second ? piece.wedge.edge_b : piece.wedge.edge_c) &&
            are_near(search, first ? own.edge_b : own.edge_c, second ? piece.edge_b : piece.edge_c))
        {
            Node b = own.c;
            if (first)
                b = own.b;
            Node d = piece.c;
            if (second)
                d = piece.b;
            consider_edges(search, own.a, b, piece.a, d);
        }
    }
}

// Wedges of both fans are tested in pairs, each by one thread of the search.
void consider_fan(inout Search search, Fan fan)
{
    const uint own_wedges = search.fan.wedges;
    for (uint k = search.lane; k < own_wedges * fan.wedges; k += search.lanes)
    {
        const uint j = k % own_wedges;
        const Piece piece = piece_of(search, fan, k / own_wedges);
        if (search.own_wedge != j)
            search.own = piece_of(search, search.fan, j);
        search.own_wedge = j;
        if (!overlap(grown(piece.box, search.range + search.rounding), search.own.box))
            continue;
        if (j == 0)
            consider_triangle(search, search.own.a, piece);
        if (k < own_wedges)
            consider_triangle(search, piece.a, search.own);
        consider_spokes(search, search.own, piece);
    }
}

Search search_of(uint vertex, PairList list, uint lane)
{
    Search search;
    search.fan = fan_of(list.cloth, vertex);
    search.from = viewpoint_of(vertex);
    search.range = list.range;
    search.rounding = 4 * rounding(search.from.x);
    search.count = 0;
    search.lane = lane;
    search.lanes = push.lanes;
    search.own_wedge = search.fan.wedges;
    return search;
}

shared float shared_ranges[gl_WorkGroupSize.x];
shared uint shared_counts[gl_WorkGroupSize.x];

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
        search = search_of(vertex, list, search.lane);
        for (uint k = 0; k < list.counts; ++k)
        {
            const uint other = candidates[vertex * VOILE_PAIR_CANDIDATES + k];
            consider_fan(search, fan_of(pair_lists[other].cloth, other));
        }
    }
    list = merged_list(thread, search, list);
    if (!searches || search.lane != 0)
        return;
    pair_lists[vertex].range = list.range;
    pair_lists[vertex].counts = list.counts;
}
