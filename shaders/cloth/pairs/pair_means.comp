#version 460
#extension GL_GOOGLE_include_directive : require
// How many vertices cloths have that collide with other cloth, and the sums of which their mean motion follows. One thread
// per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

// Means (FrameSums), and the number of vertices.
const uint k_means = VOILE_FRAME_SUMS - VOILE_FRAME_RESTRAINTS;
const uint k_values = k_means + 1;

#include "shared/finite.glsl"
#include "shared/patch.glsl"
#include "pairs/cloth_origin.glsl"
#include "pairs/fold.glsl"
#include "pairs/frame_sums.glsl"
#include "pairs/isolated.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/pair_tree.glsl"

// `r`: m, from the origin.
void write_part(vec3 r, vec3 v, out float part[k_values])
{
    const vec3 spin = cross(r, v);
    const vec3 beside = r.yzx * r.zxy;
    for (uint k = 0; k < 3; ++k)
    {
        part[VOILE_FRAME_VELOCITIES - VOILE_FRAME_RESTRAINTS + k] = v[k];
        part[VOILE_FRAME_POSITIONS - VOILE_FRAME_RESTRAINTS + k] = r[k];
        part[VOILE_FRAME_SPINS - VOILE_FRAME_RESTRAINTS + k] = spin[k];
        part[VOILE_FRAME_SPREADS - VOILE_FRAME_RESTRAINTS + k] = r[k] * r[k];
        part[VOILE_FRAME_SPREADS - VOILE_FRAME_RESTRAINTS + 3 + k] = beside[k];
    }
    part[k_means] = 1;
}

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (!collides_with_itself(self.cloth)) // the cloth of all threads
        return;
    float part[k_values];
    for (uint k = 0; k < k_values; ++k)
        part[k] = 0;
    const vec3 x = self.exists ? positions[self.index].xyz : vec3(0);
    const vec3 v = self.exists ? velocity_at_pass(velocities[self.index].xyz, cloths[self.cloth].flags) : vec3(0);
    if (self.exists && is_finite(x) && is_finite(v) && !is_isolated(self))
        write_part(x - origin_of(self.cloth), v, part);
    fold(gl_LocalInvocationID.x, k_values, part);
    if (gl_LocalInvocationID.x != 0)
        return;
    atomicAdd(pair_islands[self.cloth].vertices, uint(part[k_means]));
    for (uint k = 0; k < k_means; ++k)
    {
        const uint sum = VOILE_FRAME_RESTRAINTS + k;
        const ivec2 words = frame_words(part[k], sum, gl_NumWorkGroups.x);
        atomicAdd(pair_islands[self.cloth].frame_sums.low[sum], uint(words.x));
        atomicAdd(pair_islands[self.cloth].frame_sums.high[sum], words.y);
    }
}
