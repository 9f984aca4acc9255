#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the pairs of near primitives of all cloths that collide with themselves and each other. A vertex searches for
// all primitives that it owns (fan.glsl) at once. Neighboring threads share a search, as many as the dispatch has
// workgroups along y: all traverse the hierarchy, each tests a part of the wedges and fills a part of the list.
//
// Vertices move along sweeps. A pair is listed if the distance of its sweeps is at most the range of the owner. A list
// that is full keeps the nearest pairs, and the range shrinks to the nearest pair that it leaves out. The owner of the
// other side decides by the same distance and a range of its own.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_boxes)) readonly buffer PairBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_lists)) writeonly buffer PairLists { PairList pair_lists[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "contact/rounding.glsl"
#include "shared/box.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair.glsl"
#include "pairs/pair_tree.glsl"

// A vertex halfway along its sweep.
struct Node
{
    vec3 x;      // m, from the search's origin
    float reach; // m, half the sweep
    uint vertex;
};

// A wedge with its vertices. A spoke that the fan does not own repeats the center. Spheres are around a primitive
// with its sweeps: the middle and the radius.
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
    uint cloth;
    vec3 origin; // m, the middle of the vertex's sweep
    Box box;
    float range;
    float rounding; // m, of positions near it
    uint count;
    uint lane;
    uint lanes;
    uint own_wedge; // its piece is in `own`
    Piece own;
};

#define VOILE_QUERY Search

// Rounding of spheres, as a part of their radii.
const float k_sphere_rounding = 1e-5;

bool enters_node(Search search, Box node) { return overlap(search.box, node); }

Node node_of(Search search, uint vertex)
{
    const vec4 midpoint = midpoints[vertex];
    return Node(midpoint.xyz - search.origin, midpoint.w, vertex);
}

vec4 sphere_around(Node a, Node b)
{
    return vec4(0.5 * (a.x + b.x), 0.5 * distance(a.x, b.x) + max(a.reach, b.reach));
}

vec4 sphere_around(Node a, Node b, Node c)
{
    const vec3 middle = (a.x + b.x + c.x) / 3;
    const vec3 radii = vec3(distance(middle, a.x), distance(middle, b.x), distance(middle, c.x));
    return vec4(middle, max(radii.x, max(radii.y, radii.z)) + max(a.reach, max(b.reach, c.reach)));
}

Piece piece_of(Search search, Fan fan, uint k)
{
    Piece piece;
    piece.wedge = wedge_of(fan, k);
    piece.a = node_of(search, fan.center);
    piece.b = piece.wedge.triangle || piece.wedge.edge_b ? node_of(search, piece.wedge.b) : piece.a;
    piece.c = piece.wedge.triangle || piece.wedge.edge_c ? node_of(search, piece.wedge.c) : piece.a;
    // As distance_of, with the longest sweep of all vertices.
    const float reach = max(piece.a.reach, max(piece.b.reach, piece.c.reach));
    piece.box = grown(joined(box_around(piece.a.x, piece.b.x), Box(piece.c.x, piece.c.x)), reach);
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

// m: the distance of both sides, less what they may move along their sweeps. Both sides of a pair find the same bits,
// because they compute it in the order of the pair.
float distance_of(uvec4 vertices, bool edges)
{
    const vec4 first = midpoints[vertices.x];
    vec3 x[4];
    vec4 reach;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        const vec4 midpoint = midpoints[vertices[k]];
        x[k] = midpoint.xyz - first.xyz;
        reach[k] = midpoint.w;
    }
    const float far = max(reach.z, reach.w);
    const float sweeps = edges ? max(reach.x, reach.y) + far : reach.x + max(reach.y, far);
    return length(nearest_points(edges, x).apart) - sweeps - 2 * rounding(first.xyz);
}

void consider(inout Search search, uvec4 vertices, bool edges)
{
    const float at = distance_of(vertices, edges);
    if (at <= search.range)
        insert(search, vertices, edges, at);
}

// False: distance_of is more than the range.
bool are_near(Search search, vec4 a, vec4 b)
{
    const vec3 apart = a.xyz - b.xyz;
    const float near = (a.w + b.w) * (1 + k_sphere_rounding) + search.range + search.rounding;
    return dot(apart, apart) <= near * near;
}

void consider_triangle(inout Search search, Node v, Piece piece)
{
    if (piece.wedge.triangle && are_near(search, vec4(v.x, v.reach), piece.triangle) && v.vertex != piece.a.vertex &&
        v.vertex != piece.b.vertex && v.vertex != piece.c.vertex)
        consider(search, ordered_triangle(v.vertex, uvec3(piece.a.vertex, piece.b.vertex, piece.c.vertex)), false);
}

void consider_edges(inout Search search, uvec2 a, uvec2 b)
{
    if (a.x != b.x && a.x != b.y && a.y != b.x && a.y != b.y)
        consider(search, ordered_edges(a, b), true);
}

void consider_spokes(inout Search search, Piece own, Piece piece)
{
    for (uint k = 0; k < 4; ++k)
    {
        const bool first = (k & 1u) == 0;
        const bool second = (k & 2u) == 0;
        if ((first ? own.wedge.edge_b : own.wedge.edge_c) && (second ? piece.wedge.edge_b : piece.wedge.edge_c) &&
            are_near(search, first ? own.edge_b : own.edge_c, second ? piece.edge_b : piece.edge_c))
            consider_edges(search, uvec2(own.a.vertex, first ? own.b.vertex : own.c.vertex),
                           uvec2(piece.a.vertex, second ? piece.b.vertex : piece.c.vertex));
    }
}

// `leaf`: a box of the hierarchy. Wedges of both fans are tested in pairs, each by one thread of the search.
void visit_leaf(inout Search search, uint leaf, uint count)
{
    const uint vertex = padded_boxes[leaf].padding_0;
    const uint other = padded_boxes[leaf].padding_1;
    if (vertex == search.fan.center || !meets(search.cloth, other))
        return;
    const Fan fan = fan_of(other, vertex);
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

#include "colliders/padded.glsl"

Search search_of(PatchVertex self, uint lane)
{
    Search search;
    search.fan = fan_of(self.cloth, self.index);
    search.cloth = self.cloth;
    search.origin = midpoints[self.index].xyz;
    search.range = cloths[self.cloth].pair_range;
    search.rounding = 4 * rounding(search.origin);
    search.count = 0;
    search.lane = lane;
    search.lanes = gl_NumWorkGroups.y;
    search.box = Box(vec3(0), vec3(0));
    for (uint k = 0; k < search.fan.wedges; ++k)
    {
        const Box box = piece_of(search, search.fan, k).box;
        search.box = k == 0 ? box : joined(search.box, box);
    }
    search.own_wedge = search.fan.wedges;
    search.box = grown(shifted(search.box, search.origin), search.range + 2 * rounding(search.origin));
    return search;
}

const float k_unbounded_range = 1e30;

shared float shared_ranges[gl_WorkGroupSize.x];
shared uint shared_counts[gl_WorkGroupSize.x];

// What all threads of a search have found, in the first of them: the smallest range, and the lengths of their parts.
PairList merged_list(uint thread, Search search)
{
    shared_ranges[thread] = search.range;
    shared_counts[thread] = search.count;
    barrier();
    PairList list = PairList(search.range, search.count, search.cloth, 0);
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
    const uint lanes = gl_NumWorkGroups.y;
    const uint place = (gl_WorkGroupID.y * gl_WorkGroupSize.x + thread) / lanes;
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x, place);
    const bool searches = self.exists && collides_with_itself(self.cloth);
    Search search;
    search.lane = thread % lanes;
    search.lanes = lanes;
    search.range = k_unbounded_range;
    search.count = 0;
    search.cloth = self.cloth;
    if (searches)
    {
        search = search_of(self, thread % lanes);
        traverse_padded(search, 0, (1u << findMSB(2 * push.slots - 1)) - 1, push.slots);
    }
    const PairList list = merged_list(thread, search);
    if (searches && search.lane == 0)
        pair_lists[self.index] = list;
}
