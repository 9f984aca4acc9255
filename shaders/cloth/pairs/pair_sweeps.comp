#version 460
#extension GL_GOOGLE_include_directive : require
// Chooses how the lists of pairs expect vertices to move (sweep.glsl), and begins new lists. One thread per vertex.
//
// What is clear of colliders is carried as the island moves on average, its border less. The motion of a vertex relative to that
// becomes its sweep. A sweep lasts for the same time, but its part along the surface is short: vertices that
// sweep along the surface reach their neighbors, and any of them may stop. Those that sweep across it do not.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(pair_midpoints)) writeonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_loads)) writeonly buffer PairLoads { uint pair_loads[]; };
layout(VOILE_BINDING(pair_memories)) buffer PairMemories { PairMemory pair_memories[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(pair_islands)) readonly buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_flats)) readonly buffer PairFlats { vec2 pair_flats[]; }; // x: 1: clear of colliders
layout(VOILE_BINDING(pair_carries)) writeonly buffer PairCarries { uint pair_carries[]; };

layout(VOILE_BINDING(pair_bounds)) readonly buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/clock.glsl"
#include "pairs/fan.glsl"
#include "pairs/halvings.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/neighborhood.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"
#include "shared/mesh.glsl"

MeshVertex lists_of(uint cloth, Fan fan) { return mesh_vertices[cloths[cloth].first_list + fan.local]; }

MeshCorner corner_of(MeshVertex lists, uint k) { return mesh_corners[lists.first_corner + k * MESH_STRIDE]; }

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

vec3 mesh_normal(Fan fan, MeshVertex lists)
{
    const uint first = fan.center - fan.local;
    const vec3 x = positions[fan.center].xyz;
    vec3 sum = vec3(0);
    for (uint k = 0; k < lists.corners; ++k)
    {
        const MeshCorner corner = corner_of(lists, k);
        sum += cross(positions[first + corner.b].xyz - x, positions[first + corner.c].xyz - x);
    }
    return sum;
}

// The part of a neighborhood that is clear. In a strip of two or three lines the vertex may be all of it.
float grid_clearance(Fan fan)
{
    float clear = pair_flats[fan.center].x;
    float count = 1;
    for (uint k = 0; k < 16; ++k)
    {
        const ivec2 offset = ivec2(k_neighborhood[k & 3u], k_neighborhood[k >> 2]);
        if (!in_grid(fan.column_row + offset, fan.columns, fan.rows))
            continue;
        clear += pair_flats[int(fan.center) + offset.y * int(fan.columns) + offset.x].x;
        ++count;
    }
    return clear / count;
}

float mesh_clearance(Fan fan, MeshVertex lists)
{
    float clear = pair_flats[fan.center].x;
    for (uint k = 0; k < lists.corners; ++k)
        clear += pair_flats[fan.center - fan.local + corner_of(lists, k).b].x;
    return clear / float(1 + lists.corners);
}

// The part of the mean velocity, and of gravity if it is all.
float clearance(uint i, uint cloth, Fan fan)
{
    if (positions[i].w == 0 || is_clock_stopped(cloth))
        return 0;
    return fan.columns > 0 ? grid_clearance(fan) : mesh_clearance(fan, lists_of(cloth, fan));
}

// `v`: m/s, relative to what carries the vertex.
vec3 sweep_of(Fan fan, uint cloth, vec3 v)
{
    const vec3 normal = fan.columns > 0 ? grid_normal(fan) : mesh_normal(fan, lists_of(cloth, fan));
    const vec3 n = normal / max(length(normal), 1e-30);
    const float along = length(v - dot(v, n) * n);
    return v * min(VOILE_PAIR_SWEEP_TIME, min(cloths[cloth].pair_sweep / max(length(v), 1e-30),
                                        cloths[cloth].pair_slide / max(along, 1e-30)));
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place < VOILE_PAIR_PASSES)
        pair_passes[place] = PairDispatch(place == VOILE_PAIR_RESPOND ? 1 : 0, 1, 1, 0);
    if (place >= push.places)
        return;
    const uint i = pair_order[place].x;
    const uint cloth = pair_order[place].y;
    if (!collides_with_itself(cloth))
        return;
    const Fan fan = fan_of(cloth, i);
    const float clear = clearance(i, cloth, fan);
    const uint carry_word = pack_carry(clear * mean_velocity(island_of(cloth))) | (clear == 1 ? k_falls_bit : 0);
    const vec3 own = velocities[i].xyz;
    const vec3 v = positions[i].w > 0 ? velocity_at_pass(own, cloths[cloth].flags) : own;
    const vec3 relative = v - velocity_at(frame_of(cloth), positions[i].xyz, 0) - carry_velocity(carry_word);
    const uint memory = pair_memories[i].pass;
    const uint halvings =
        next_halvings(halvings_of(memory), pair_bounds[i].sweep, pair_interval() * length(relative));
    pair_memories[i].pass = with_halvings(memory, halvings);
    const float part = exp2(-float(halvings_with(halvings, pair_bounds[i].sweep, memory)));
    const uint word = pack_half_sweep(0.5 * part * sweep_of(fan, cloth, relative));
    pair_carries[i] = carry_word;
    midpoints[i] = vec4(positions[i].xyz + unpack_half_sweep(carry_word) + unpack_half_sweep(word), uintBitsToFloat(word));
    pair_loads[i] = pair_loads[push.vertices + i] = 0;
    pair_memories[i].friction = packHalf2x16(vec2(cloths[cloth].static_friction, cloths[cloth].kinetic_friction));
}
