#version 460
#extension GL_GOOGLE_include_directive : require
// Whether vertices that collide with other cloth are clear of all colliders for some time, so that nothing but cloth can
// stop them or their neighbors, how fast those that are move, and where each cloth is. One thread per vertex.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;
const float k_unbounded = 1e30;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pair_flats)) writeonly buffer PairFlats { vec2 pair_flats[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "pairs/clear.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/neighborhood.glsl"
#include "pairs/pair_tree.glsl"
#include "shared/ordered.glsl"

// Edges and corners of colliders push vertices that are an edge of the cloth away. What springs, tethers or bounds hold
// does not move as its island does.
bool is_clear_vertex(uint i, uint cloth)
{
    const float margin = cloths[cloth].thickness + (k_neighborhood_radius + 1) * cloths[cloth].springs[0].rest_length;
    const bool held = (uint(velocities[i].w) & (VOILE_VERTEX_HELD | VOILE_VERTEX_BOUND)) != 0;
    const bool moves = positions[i].w > 0 && !held && (cloths[cloth].flags & VOILE_CLOTH_ASLEEP) == 0;
    return moves &&
           is_clear(positions[i].xyz, VOILE_PAIR_SWEEP_TIME * velocities[i].xyz, margin, cloths[cloth].layers);
}

// Of some vertices of a cloth.
struct Part
{
    vec3 momentum; // m/s, of its heaviest vertex, summed over those that are clear
    float mass;    // of those, relative to the heaviest
    float clear;
    Box box;
    float vertices;
};

shared Part shared_parts[gl_WorkGroupSize.x];

Part joined(Part a, Part b)
{
    return Part(a.momentum + b.momentum, a.mass + b.mass, a.clear + b.clear, joined(a.box, b.box), a.vertices + b.vertices);
}

// The order does not depend on timing: groups add whole numbers.
void add_to_cloth(uint cloth, Part part)
{
    const ivec3 sum = ivec3(round(part.momentum / (VOILE_PAIR_UNIT_SPEED * float(push.places))));
    for (uint k = 0; k < 3; ++k)
    {
        atomicAdd(pair_islands[cloth].momentum[k], sum[k]);
        atomicMax(pair_islands[cloth].low[k], ~ordered(part.box.min[k]));
        atomicMax(pair_islands[cloth].high[k], ordered(part.box.max[k]));
    }
    atomicAdd(pair_islands[cloth].mass, uint(round(part.mass / (VOILE_PAIR_UNIT_MASS * float(push.places)))));
    atomicAdd(pair_islands[cloth].clear, uint(part.clear));
    atomicAdd(pair_islands[cloth].vertices, uint(part.vertices));
}

Part part_of(PatchVertex self, bool clear)
{
    if (!self.exists)
        return Part(vec3(0), 0, 0, Box(vec3(k_unbounded), vec3(-k_unbounded)), 0);
    const vec3 x = positions[self.index].xyz;
    const float mass = clear ? 1 / (positions[self.index].w * cloths[self.cloth].pair_mass) : 0;
    const vec3 v = velocity_at_pass(velocities[self.index].xyz, cloths[self.cloth].flags);
    return Part(mass * v, mass, clear ? 1 : 0, Box(x, x), 1);
}

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (!collides_with_itself(self.cloth)) // the cloth of all threads
        return;
    const bool clear = self.exists && is_clear_vertex(self.index, self.cloth);
    if (self.exists)
        pair_flats[self.index] = vec2(clear ? 1 : 0, 0);
    const uint thread = gl_LocalInvocationID.x;
    shared_parts[thread] = part_of(self, clear);
    for (uint width = gl_WorkGroupSize.x / 2; width > 0; width /= 2)
    {
        barrier();
        if (thread < width)
            shared_parts[thread] = joined(shared_parts[thread], shared_parts[thread + width]);
    }
    if (thread == 0)
        add_to_cloth(self.cloth, shared_parts[0]);
}
