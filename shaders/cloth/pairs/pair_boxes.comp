#version 460
#extension GL_GOOGLE_include_directive : require
// Sweeps of vertices, and the boxes of the leaves of the hierarchy of pairs (pair_tree.glsl), around the sweeps of all
// primitives that a vertex owns. One thread per slot. The box of a leaf also contains the vertex and its cloth.
// refit.comp folds the boxes.
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
layout(VOILE_BINDING(pair_midpoints)) writeonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_loads)) writeonly buffer PairLoads { uint pair_loads[]; };
layout(VOILE_BINDING(pair_memories)) buffer PairMemories { PairMemory pair_memories[]; };
layout(VOILE_BINDING(pair_passes)) writeonly buffer PairPasses { PairDispatch pair_passes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/grid.glsl"
#include "pairs/fan.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

void start_vertex(uint i, uint cloth)
{
    const vec3 sweep = sweep_of(i);
    midpoints[i] = vec4(positions[i].xyz + 0.5 * sweep, 0.5 * length(sweep));
    pair_loads[i] = pair_loads[push.vertices + i] = 0;
    pair_memories[i].friction = packHalf2x16(vec2(cloths[cloth].static_friction, cloths[cloth].kinetic_friction));
}

void main()
{
    const uint width = 1u << findMSB(2 * push.slots - 1); // of the level of leaves
    const uint slot = gl_GlobalInvocationID.x;
    if (slot == 0)
    {
        pair_passes[VOILE_PAIR_MEET] = PairDispatch(0, 1, 1, 0);
        pair_passes[VOILE_PAIR_RESPOND] = PairDispatch(0, 1, 1, 0);
        pair_passes[VOILE_PAIR_REFERENCES] = PairDispatch(0, 1, 1, 0);
    }
    if (slot >= width)
        return;
    const uvec2 entry = pair_order[place_of_slot(slot, push.slots)];
    Box box = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u))); // empty
    if (collides_with_itself(entry.y))
    {
        box = fan_box(fan_of(entry.y, entry.x));
        if (slot < push.slots) // others repeat a vertex
            start_vertex(entry.x, entry.y);
    }
    boxes[width - 1 + slot] = PaddedBox(box.min, entry.x, box.max, entry.y);
}
