#version 460
#extension GL_GOOGLE_include_directive : require
// The boxes of the leaves of the hierarchy of pairs (pair_tree.glsl): around the sweeps of all primitives that a vertex
// owns. One thread per slot. refit.comp folds them.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_boxes)) writeonly buffer PairBoxes { PaddedBox boxes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/grid.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

void main()
{
    const uint width = 1u << findMSB(2 * push.slots - 1); // of the level of leaves
    const uint slot = gl_GlobalInvocationID.x;
    if (slot >= width)
        return;
    const uvec2 entry = pair_order[place_of_slot(slot, push.slots)];
    Box box = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u))); // empty
    if (collides_with_itself(entry.y))
        box = fan_box(fan_of(entry.y, entry.x));
    boxes[width - 1 + slot] = PaddedBox(box.min, 0, box.max, 0);
}
