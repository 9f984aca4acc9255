#version 460
#extension GL_GOOGLE_include_directive : require
// Whether vertices that collide with other cloth are clear of all colliders for some time, so that nothing but cloth can
// stop them or their neighbors, and how fast those that are move on average. One thread per vertex.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pair_flats)) writeonly buffer PairFlats { vec2 pair_flats[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "pairs/clear.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/neighborhood.glsl"
#include "pairs/pair_tree.glsl"

// Edges and corners of colliders push vertices that are an edge of the cloth away.
bool is_clear_vertex(uint i, uint cloth)
{
    const float margin = cloths[cloth].thickness + (k_neighborhood_radius + 1) * cloths[cloth].springs[0].rest_length;
    return positions[i].w > 0 &&
           is_clear(positions[i].xyz, VOILE_PAIR_SWEEP_TIME * velocities[i].xyz, margin, cloths[cloth].layers);
}

shared vec4 shared_sums[gl_WorkGroupSize.x];

// The order does not depend on timing: groups add whole numbers.
void add_velocities(uint thread, vec4 velocity)
{
    shared_sums[thread] = velocity;
    for (uint width = gl_WorkGroupSize.x / 2; width > 0; width /= 2)
    {
        barrier();
        if (thread < width)
            shared_sums[thread] += shared_sums[thread + width];
    }
    if (thread > 0 || shared_sums[0].w == 0)
        return;
    const ivec3 sum = ivec3(round(shared_sums[0].xyz / (VOILE_PAIR_UNIT_SPEED * float(push.places))));
    atomicAdd(pair_passes[VOILE_PAIR_CLEAR].groups, uint(sum.x));
    atomicAdd(pair_passes[VOILE_PAIR_CLEAR].wanted, uint(sum.y));
    atomicAdd(pair_passes[VOILE_PAIR_CLEAR].one, uint(sum.z));
    atomicAdd(pair_passes[VOILE_PAIR_CLEAR].entries, uint(shared_sums[0].w));
}

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    const bool collides = self.exists && collides_with_itself(self.cloth);
    const bool clear = collides && is_clear_vertex(self.index, self.cloth);
    if (collides)
        pair_flats[self.index] = vec2(clear ? 1 : 0, 0);
    vec4 velocity = vec4(0);
    if (clear)
        velocity = vec4(velocity_at_pass(velocities[self.index].xyz, cloths[self.cloth].flags), 1);
    add_velocities(gl_LocalInvocationID.x, velocity);
}
