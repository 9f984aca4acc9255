#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the pairs of near primitives of all cloths that collide with themselves and each other. One thread per vertex,
// which searches for all primitives that the vertex owns (fan.glsl) at once.
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
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_boxes)) readonly buffer PairBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pairs)) writeonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_ranges)) writeonly buffer PairRanges { vec2 pair_ranges[]; };
layout(VOILE_BINDING(pair_sweeps)) writeonly buffer PairSweeps { PairSweep pair_sweeps[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

// The search of a vertex, and the list that it fills.
struct Search
{
    Fan fan;
    uint cloth;
    FinePosition origin; // the vertex itself
    Box box;
    float range;
    uint count;
};

#define VOILE_QUERY Search

bool enters_node(Search search, Box node) { return overlap(search.box, node); }

// A vertex halfway along its sweep.
struct Midpoint
{
    vec3 x; // m, from the search's origin
    float reach; // m, half the sweep
};

Midpoint midpoint_of(Search search, uint i)
{
    const FinePosition x = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    const vec3 sweep = sweep_of(i);
    return Midpoint(displacement(search.origin, x) + 0.5 * sweep, 0.5 * length(sweep));
}

// m: a pair that is nearer at rest repels from half of its distance there on.
float pair_thickness(Pair pair, float thickness, bool same_cloth)
{
    if (!same_cloth)
        return thickness;
    vec3 x[4];
    for (uint k = 0; k < 4; ++k)
        x[k] = start[pair.vertices[k]].xyz;
    return min(thickness, 0.5 * length(nearest_points(pair.edges, x).apart));
}

void insert(inout Search search, Pair pair, float at)
{
    const uint first = search.fan.center * VOILE_PAIRS;
    uint place = search.count;
    if (search.count < VOILE_PAIRS)
        ++search.count;
    else
    {
        float farthest = at;
        for (uint k = 0; k < VOILE_PAIRS; ++k)
            if (pair_distances[first + k] > farthest)
            {
                farthest = pair_distances[first + k];
                place = k;
            }
        search.range = min(search.range, farthest);
        if (place == VOILE_PAIRS)
            return;
    }
    pairs[first + place] = packed(pair);
    pair_distances[first + place] = at;
}

// Lists a pair if it is near enough. `other`: the cloth of the other side.
void consider(inout Search search, uint other, uvec4 vertices, bool edges)
{
    vec3 x[4];
    vec4 reach;
    for (uint k = 0; k < 4; ++k)
    {
        const Midpoint m = midpoint_of(search, vertices[k]);
        x[k] = m.x;
        reach[k] = m.reach;
    }
    // Of the farthest vertices on both sides.
    const float sweeps = edges ? max(reach.x, reach.y) + max(reach.z, reach.w)
                               : reach.x + max(reach.y, max(reach.z, reach.w));
    const float at = length(nearest_points(edges, x).apart) - sweeps - 1e-6 * length(x[3]);
    if (at > search.range)
        return;
    const float thickness = 0.5 * (cloths[search.cloth].pair_thickness + cloths[other].pair_thickness);
    Pair pair = Pair(vertices, edges, thickness);
    pair.thickness = pair_thickness(pair, thickness, search.cloth == other);
    insert(search, pair, at);
}

void consider_triangle(inout Search search, uint other, uint vertex, uint center, Wedge wedge)
{
    if (wedge.triangle && vertex != center && vertex != wedge.b && vertex != wedge.c)
        consider(search, other, ordered_triangle(vertex, uvec3(center, wedge.b, wedge.c)), false);
}

void consider_edges(inout Search search, uint other, uvec2 a, uvec2 b)
{
    if (a.x != b.x && a.x != b.y && a.y != b.x && a.y != b.y)
        consider(search, other, ordered_edges(a, b), true);
}

void consider_wedges(inout Search search, uint other, Wedge own, uint center, Wedge wedge)
{
    for (uint k = 0; k < 4; ++k)
    {
        const bool first = (k & 1u) == 0;
        const bool second = (k & 2u) == 0;
        if ((first ? own.edge_b : own.edge_c) && (second ? wedge.edge_b : wedge.edge_c))
            consider_edges(search, other, uvec2(search.fan.center, first ? own.b : own.c),
                           uvec2(center, second ? wedge.b : wedge.c));
    }
}

void visit_leaf(inout Search search, uint slot, uint count)
{
    const uvec2 entry = pair_order[place_of_slot(slot, push.slots)];
    const uint vertex = entry.x;
    const uint other = entry.y;
    if (vertex == search.fan.center || !meets(search.cloth, other))
        return;
    const Fan fan = fan_of(other, vertex);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        consider_triangle(search, other, search.fan.center, vertex, wedge);
        for (uint j = 0; j < search.fan.wedges; ++j)
            consider_wedges(search, other, wedge_of(search.fan, j), vertex, wedge);
    }
    for (uint j = 0; j < search.fan.wedges; ++j)
        consider_triangle(search, other, vertex, search.fan.center, wedge_of(search.fan, j));
}

#include "colliders/padded.glsl"

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (!self.exists || (cloths[self.cloth].flags & VOILE_CLOTH_SELF_COLLISION) == 0)
        return;
    const uint i = self.index;
    Search search;
    search.fan = fan_of(self.cloth, i);
    search.cloth = self.cloth;
    search.origin = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    search.range = cloths[self.cloth].pair_range;
    search.count = 0;
    search.box = grown(fan_box(search.fan), search.range);
    traverse_padded(search, 0, 0, push.slots);
    pair_ranges[i] = vec2(search.range, uintBitsToFloat(search.count));
    PairSweep sweep;
    sweep.from = search.origin.x;
    sweep.reach = 0; // until the first pass over the lists
    sweep.sweep = sweep_of(i);
    sweep.residual = residuals[i];
    pair_sweeps[i] = sweep;
}
