#version 460
#extension GL_GOOGLE_include_directive : require
// Chooses the sweeps of the vertices that collide with other cloth, and begins new lists. One thread per vertex.
//
// A sweep lasts for the sweep time, but its part along the surface is short. Vertices that sweep along the surface reach
// their neighbors, and any of them may stop. Those that sweep across it do not.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_midpoints)) writeonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_loads)) writeonly buffer PairLoads { uint pair_loads[]; };
layout(VOILE_BINDING(pair_memories)) buffer PairMemories { PairMemory pair_memories[]; };
layout(VOILE_BINDING(pair_passes)) writeonly buffer PairPasses { PairDispatch pair_passes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/fan.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

vec3 grid_normal(Fan fan)
{
    const ivec2 last = ivec2(fan.columns, fan.rows) - 1;
    const ivec2 low = max(fan.column_row - 1, ivec2(0)) - fan.column_row;
    const ivec2 high = min(fan.column_row + 1, last) - fan.column_row;
    const vec3 along = positions[fan.center + high.x].xyz - positions[fan.center + low.x].xyz;
    const int columns = int(fan.columns);
    const vec3 down = positions[int(fan.center) + high.y * columns].xyz - positions[int(fan.center) + low.y * columns].xyz;
    return cross(along, down);
}

vec3 mesh_normal(Fan fan)
{
    const uint first = fan.center - fan.local;
    const vec3 x = positions[fan.center].xyz;
    vec3 sum = vec3(0);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const MeshCorner corner = fan_corner(fan, k);
        sum += cross(positions[first + corner.b].xyz - x, positions[first + corner.c].xyz - x);
    }
    return sum;
}

vec3 sweep_of(uint i, uint cloth)
{
    const Fan fan = fan_of(cloth, i);
    const vec3 normal = fan.columns > 0 ? grid_normal(fan) : mesh_normal(fan);
    const vec3 n = normal / max(length(normal), 1e-30);
    const vec3 v = velocities[i].xyz;
    const float along = length(v - dot(v, n) * n);
    return v * min(push.sweep_time, min(cloths[cloth].pair_sweep / max(length(v), 1e-30),
                                        cloths[cloth].pair_slide / max(along, 1e-30)));
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place < VOILE_PAIR_PASSES)
        pair_passes[place] = PairDispatch(0, 1, 1, 0);
    if (place >= push.places)
        return;
    const uint i = pair_order[place].x;
    const uint cloth = pair_order[place].y;
    if (!collides_with_itself(cloth))
        return;
    const vec3 half_sweep = 0.5 * sweep_of(i, cloth);
    const uint word = pack_half_sweep(half_sweep);
    midpoints[i] = vec4(positions[i].xyz + unpack_half_sweep(word), uintBitsToFloat(word));
    pair_loads[i] = pair_loads[push.vertices + i] = 0;
    pair_memories[i].friction = packHalf2x16(vec2(cloths[cloth].static_friction, cloths[cloth].kinetic_friction));
}
