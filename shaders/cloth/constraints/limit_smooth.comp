#version 460
#extension GL_GOOGLE_include_directive : require
// Takes part of the velocity of neighbors relative to each other, after the passes of the strain limit on a softened
// cloth. Corrections leave waves of a few vertices in the velocities, which soft dashpots hardly damp: cloth would
// shake.
//
// Of a rotation it takes nothing. From the velocity between two neighbors that of a rotation is subtracted, with the
// mean of their angular velocities (limit_spin.comp). Momentum is kept, since both ends take opposite parts. Angular
// momentum is kept, since around each vertex the moments of what remains add up to zero: that is what least squares
// mean.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(next_positions)) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(VOILE_BINDING(next_velocities)) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(VOILE_BINDING(next_residuals)) writeonly buffer NextResiduals { uvec2 next_residuals[]; };
layout(VOILE_BINDING(step_velocities)) readonly buffer StepVelocities { vec4 step_velocities[]; };
layout(VOILE_BINDING(limit_vertices)) readonly buffer LimitVertices { LimitVertex limit_vertices[]; };
layout(VOILE_BINDING(limit_levels)) readonly buffer LimitLevels { LimitLevel limit_levels[]; };
layout(VOILE_BINDING(limit_links)) readonly buffer LimitLinks { LimitLink limit_links[]; };
layout(VOILE_BINDING(spins)) readonly buffer Spins { vec4 spins[]; };

#include "shared/patch.glsl"
#include "constraints/limit_neighbors.glsl"

// m/s
vec3 smoothing(PatchVertex self)
{
    const Neighborhood n = neighborhood(self);
    const VertexState own = state_of(self.index);
    const vec4 own_spin = spins[self.index];
    vec3 change = vec3(0);
    for (uint first = 0; first < n.count; first += VOILE_LEVEL_NEIGHBORS)
    {
        VertexState others[VOILE_LEVEL_NEIGHBORS];
        vec4 other_spins[VOILE_LEVEL_NEIGHBORS];
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
        {
            const uint other = neighbor_index(n, first + k);
            others[k] = state_of(other);
            other_spins[k] = spins[other];
        }
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
        {
            const vec3 spin = 0.5 * (own_spin.xyz + other_spins[k].xyz);
            const vec3 dv = others[k].v - own.v - cross(spin, others[k].x - own.x);
            const float fraction = own.inverse_mass * reduced_mass(own.inverse_mass, others[k].inverse_mass);
            change += k_smoothing * min(own_spin.w, other_spins[k].w) * fraction * dv;
        }
    }
    return change;
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists || self.asleep)
        return;
    const uint i = self.index;
    next_positions[i] = positions[i];
    next_residuals[i] = residuals[i];
    const vec4 v = velocities[i];
    next_velocities[i] = is_smoothed(self) && positions[i].w > 0 ? vec4(v.xyz + smoothing(self), v.w) : v;
}
