#version 460
#extension GL_GOOGLE_include_directive : require
// How many vertices cloths have that collide with other cloth, and the sums of their velocities. One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

const uint k_values = 4;

#include "shared/finite.glsl"
#include "shared/patch.glsl"
#include "pairs/fold.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/moving_frame.glsl"
#include "pairs/pair_tree.glsl"

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (!collides_with_itself(self.cloth)) // the cloth of all threads
        return;
    vec3 v = self.exists ? velocity_at_pass(velocities[self.index].xyz, cloths[self.cloth].flags) : vec3(0);
    const bool counts = self.exists && is_finite(v);
    if (!counts)
        v = vec3(0);
    float sums[k_values] = float[k_values](v.x, v.y, v.z, counts ? 1 : 0);
    fold(gl_LocalInvocationID.x, k_values, sums);
    if (gl_LocalInvocationID.x != 0)
        return;
    atomicAdd(pair_islands[self.cloth].vertices, uint(sums[3]));
    for (uint k = 0; k < 3; ++k)
    {
        const int units = frame_units(sums[k], VOILE_FRAME_ALL + k);
        atomicAdd(pair_islands[self.cloth].frame_sums.low[VOILE_FRAME_ALL + k], uint(units & 0xffff));
        atomicAdd(pair_islands[self.cloth].frame_sums.high[VOILE_FRAME_ALL + k], units >> 16);
    }
}
