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
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_boxes)) readonly buffer PairBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_ranges)) writeonly buffer PairRanges { vec2 pair_ranges[]; };
layout(VOILE_BINDING(pair_entries)) writeonly buffer PairEntries { uint pair_entries[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(pair_patches)) writeonly buffer PairPatches { uint pair_patches[]; };
layout(VOILE_BINDING(pair_marks)) buffer PairMarks { uint pair_marks[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

// The search of a vertex, and the list that it fills.
struct Search
{
    Fan fan;
    uint cloth;
    vec3 origin; // m, the middle of the vertex's sweep
    Box box;
    float range;
    uint count;
    uint lane;
    uint lanes;
};

#define VOILE_QUERY Search

bool enters_node(Search search, Box node) { return overlap(search.box, node); }

// A vertex halfway along its sweep.
struct Node
{
    vec3 x;      // m, from the search's origin
    float reach; // m, half the sweep
    uint vertex;
};

Node node_of(Search search, uint vertex)
{
    const vec4 midpoint = midpoints[vertex];
    return Node(midpoint.xyz - search.origin, midpoint.w, vertex);
}

// A wedge with its vertices. A spoke that the grid does not have repeats the center.
struct Piece
{
    Node a; // the center
    Node b;
    Node c;
    Wedge wedge;
    Box box;
};

Box around(Node node) { return Box(node.x - node.reach, node.x + node.reach); }

Piece piece_of(Search search, Fan fan, uint k)
{
    Piece piece;
    piece.wedge = wedge_of(fan, k);
    piece.a = node_of(search, fan.center);
    piece.b = piece.wedge.triangle || piece.wedge.edge_b ? node_of(search, piece.wedge.b) : piece.a;
    piece.c = piece.wedge.triangle || piece.wedge.edge_c ? node_of(search, piece.wedge.c) : piece.a;
    piece.box = joined(around(piece.a), joined(around(piece.b), around(piece.c)));
    return piece;
}

// m: a pair that is nearer at rest repels from half of its distance there on.
float pair_thickness(Pair pair, float thickness, bool same_cloth)
{
    if (!same_cloth)
        return thickness;
    vec3 x[4];
    [[unroll]] for (uint k = 0; k < 4; ++k)
        x[k] = start[pair.vertices[k]].xyz;
    return min(thickness, 0.5 * length(nearest_points(pair.edges, x).apart));
}

void insert(inout Search search, uint other, uvec4 vertices, bool edges, float at)
{
    const uint part = VOILE_PAIRS / search.lanes;
    const uint first = search.fan.center * VOILE_PAIRS + search.lane * part;
    uint place = search.count;
    if (search.count < part)
        ++search.count;
    else
    {
        float farthest = at;
        for (uint k = 0; k < part; ++k)
            if (pair_distances[first + k] > farthest)
            {
                farthest = pair_distances[first + k];
                place = k;
            }
        search.range = min(search.range, farthest);
        if (place == part)
            return;
    }
    const float thickness = 0.5 * (cloths[search.cloth].pair_thickness + cloths[other].pair_thickness);
    Pair pair = Pair(vertices, edges, thickness);
    pair.thickness = pair_thickness(pair, thickness, search.cloth == other);
    pairs[first + place] = packed(pair);
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

void consider(inout Search search, uint other, uvec4 vertices, bool edges)
{
    const float at = distance_of(vertices, edges);
    if (at <= search.range)
        insert(search, other, vertices, edges, at);
}

void consider_triangle(inout Search search, uint other, uint v, Piece piece)
{
    if (piece.wedge.triangle && v != piece.a.vertex && v != piece.b.vertex && v != piece.c.vertex)
        consider(search, other, ordered_triangle(v, uvec3(piece.a.vertex, piece.b.vertex, piece.c.vertex)), false);
}

void consider_edges(inout Search search, uint other, uvec2 a, uvec2 b)
{
    if (a.x != b.x && a.x != b.y && a.y != b.x && a.y != b.y)
        consider(search, other, ordered_edges(a, b), true);
}

void consider_spokes(inout Search search, uint other, Piece own, Piece piece)
{
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        const bool first = (k & 1u) == 0;
        const bool second = (k & 2u) == 0;
        if ((first ? own.wedge.edge_b : own.wedge.edge_c) && (second ? piece.wedge.edge_b : piece.wedge.edge_c))
            consider_edges(search, other, uvec2(own.a.vertex, first ? own.b.vertex : own.c.vertex),
                           uvec2(piece.a.vertex, second ? piece.b.vertex : piece.c.vertex));
    }
}

void visit_leaf(inout Search search, uint slot, uint count)
{
    const uvec2 entry = pair_order[place_of_slot(slot, push.slots)];
    const uint other = entry.y;
    if (entry.x == search.fan.center || !meets(search.cloth, other))
        return;
    const Fan fan = fan_of(other, entry.x);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Piece piece = piece_of(search, fan, k);
        const Box near = grown(piece.box, search.range);
        for (uint j = 0; j < search.fan.wedges; ++j)
        {
            if ((k * search.fan.wedges + j) % search.lanes != search.lane)
                continue;
            const Piece own = piece_of(search, search.fan, j);
            if (!overlap(near, own.box))
                continue;
            if (j == 0)
                consider_triangle(search, other, own.a.vertex, piece);
            if (k == 0)
                consider_triangle(search, other, piece.a.vertex, own);
            consider_spokes(search, other, own, piece);
        }
    }
}

#include "colliders/padded.glsl"

void mark(uint patch_index)
{
    if (atomicExchange(pair_marks[patch_index], 1) == 0)
        pair_patches[atomicAdd(pair_passes[VOILE_PAIR_RESPOND].groups, 1)] = patch_index;
}

// The patches of the vertices of all primitives that the vertex owns.
void mark_patches(Fan fan)
{
    const uint own = push.first_patch + gl_WorkGroupID.x;
    mark(own);
    const Patch patch_of_self = patches[own];
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        if (wedge.triangle || wedge.edge_b)
            mark(patch_of(own, patch_of_self, wedge.b - patch_of_self.first_vertex));
        if (wedge.triangle || wedge.edge_c)
            mark(patch_of(own, patch_of_self, wedge.c - patch_of_self.first_vertex));
    }
}

void publish(PatchVertex self, Search search)
{
    if (search.count == 0)
        return;
    const uint first = atomicAdd(pair_passes[VOILE_PAIR_MEET].entries, search.count);
    for (uint k = 0; k < search.count; ++k)
        pair_entries[first + k] = self.index * VOILE_PAIRS + search.lane * (VOILE_PAIRS / search.lanes) + k;
    const uint group = gl_WorkGroupSize.x;
    atomicMax(pair_passes[VOILE_PAIR_MEET].groups, (first + search.count + group - 1) / group);
    mark_patches(search.fan);
}

// Until a pass finds the vertex in a pair, only its sweep bounds it.
void bound(uint i, float range)
{
    PairSweep sweep;
    sweep.from = positions[i].xyz;
    sweep.reach = VOILE_PAIR_APPROACH * range;
    sweep.sweep = sweep_of(i);
    sweep.residual = residuals[i];
    pair_bounds[i].sweep = sweep;
    pair_bounds[i].impulse = vec3(0);
    pair_bounds[i].listed = 0;
}

Search search_of(PatchVertex self, uint lane)
{
    Search search;
    search.fan = fan_of(self.cloth, self.index);
    search.cloth = self.cloth;
    search.origin = midpoints[self.index].xyz;
    search.range = cloths[self.cloth].pair_range;
    search.count = 0;
    search.lane = lane;
    search.lanes = gl_NumWorkGroups.y;
    search.box = Box(vec3(0), vec3(0));
    for (uint k = 0; k < search.fan.wedges; ++k)
    {
        const Box box = piece_of(search, search.fan, k).box;
        search.box = k == 0 ? box : joined(search.box, box);
    }
    search.box = grown(shifted(search.box, search.origin), search.range + 2 * rounding(search.origin));
    return search;
}

const float k_unbounded_range = 1e30;

shared vec2 shared_ranges[gl_WorkGroupSize.x];

// What all threads of a search have found, in the first of them: the smallest range, and the lengths of their parts.
vec2 merged_range(uint thread, Search search)
{
    shared_ranges[thread] = vec2(search.range, uintBitsToFloat(search.count));
    barrier();
    float range = search.range;
    uint counts = search.count;
    if (search.lane == 0)
        for (uint k = 1; k < search.lanes; ++k)
        {
            range = min(range, shared_ranges[thread + k].x);
            counts |= floatBitsToUint(shared_ranges[thread + k].y) << (k * VOILE_PAIR_COUNT_BITS);
        }
    return vec2(range, uintBitsToFloat(counts));
}

void main()
{
    if (gl_WorkGroupID.y == 0 && gl_GlobalInvocationID.x < VOILE_PAIR_SEARCHES)
        pair_searches[gl_GlobalInvocationID.x].wanted = 0;
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
    if (searches)
    {
        search = search_of(self, thread % lanes);
        traverse_padded(search, 0, 0, push.slots);
        publish(self, search);
    }
    const vec2 range = merged_range(thread, search);
    if (!searches || search.lane != 0)
        return;
    bound(self.index, range.x);
    pair_ranges[self.index] = range;
}
