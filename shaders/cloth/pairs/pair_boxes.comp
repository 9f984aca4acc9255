#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The boxes of the leaves of the hierarchy of pairs (pair_tree.glsl), around the sweeps of all primitives that their
// vertices own, and how flat the cloth around each vertex is. One thread per vertex that a slot of a leaf can have; as
// many as there are vertices also have one of them. The box of a leaf contains its number, too. refit.comp folds the
// boxes.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_wedges)) readonly buffer MeshWedges { MeshWedge mesh_wedges[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_islands)) readonly buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_boxes)) writeonly buffer PairBoxes { PaddedBox boxes[]; };
layout(VOILE_BINDING(pair_flats)) writeonly buffer PairFlats { vec2 pair_flats[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "contact/rounding.glsl"
#include "shared/box.glsl"
#include "pairs/flat.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/tree_carry.glsl"
#include "pairs/wedges.glsl"

Box sweep_box(uint i, Viewpoint from)
{
    const Node node = node_of(i, from);
    return Box(node.x - extent_of(node), node.x + extent_of(node));
}

// Around the primitives that a vertex owns, rounding included.
Box fan_box(Fan fan, Viewpoint from)
{
    Box box = sweep_box(fan.center, from);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        if (wedge.triangle || wedge.edge_b)
            box = joined(box, sweep_box(wedge.b, from));
        if (wedge.triangle || wedge.edge_c)
            box = joined(box, sweep_box(wedge.c, from));
    }
    return grown(box, rounding(box.min) + rounding(box.max));
}

Box place_box(uint place)
{
    const Box empty = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u)));
    if (place >= push.places)
        return empty;
    const uvec2 entry = pair_order[place];
    if (!collides_with_itself(entry.y))
        return empty;
    return fan_box(fan_of(entry.y, entry.x), tree_viewpoint(vec3(0), entry.y));
}

shared Box shared_boxes[gl_WorkGroupSize.x];

// Each of the threads of a leaf has the box of a vertex, the first one joins them.
void write_leaf(uint thread, uint slot)
{
    const uint width = 1u << findMSB(2 * push.leaves - 1); // of the level of leaves
    const uint lane = thread % VOILE_PAIR_LEAF;
    const uint leaf = slot < width ? leaf_of_slot(slot, push.leaves) : 0;
    if (slot < width)
        shared_boxes[thread] = place_box(leaf * VOILE_PAIR_LEAF + lane);
    barrier();
    if (slot >= width || lane != 0)
        return;
    Box box = shared_boxes[thread];
    for (uint k = 1; k < VOILE_PAIR_LEAF; ++k)
        box = joined(box, shared_boxes[thread + k]);
    boxes[width - 1 + slot] = PaddedBox(box.min, leaf, box.max, 0);
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    write_leaf(gl_LocalInvocationID.x, place / VOILE_PAIR_LEAF);
    if (place >= push.places)
        return;
    const uvec2 entry = pair_order[place];
    if (!collides_with_itself(entry.y))
        return;
    const Fan fan = fan_of(entry.y, entry.x);
    const vec3 x = midpoints[entry.x].xyz;
    const Flat flat_around = fan.columns > 0 ? flatness(fan, 16 * rounding(x)) : Flat(0, 0);
    pair_flats[entry.x] = vec2(flat_around.wide, flat_around.narrow);
}
