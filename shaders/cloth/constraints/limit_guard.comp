#version 460
#extension GL_GOOGLE_include_directive : require
// Moves the state back towards the state before the strain limit where the limit has raised a cloth's energy. The
// straight line between both crosses no surface: contact has checked it.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(limit_scales)) readonly buffer LimitScales { LimitScale scales[]; };
layout(VOILE_BINDING(before_positions)) readonly buffer BeforePositions { vec4 before[]; };
layout(VOILE_BINDING(before_velocities)) readonly buffer BeforeVelocities { vec4 velocities_before[]; };
layout(VOILE_BINDING(before_residuals)) readonly buffer BeforeResiduals { uvec2 residuals_before[]; };
layout(VOILE_BINDING(positions)) buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(residuals)) buffer Residuals { uvec2 residuals[]; };

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists || self.asleep || cloths[self.cloth].strain_limit == 0)
        return;
    const LimitScale scale = scales[self.cloth];
    const uint i = self.index;
    // Verlet's next kick depends on the contacts of the last substep.
    velocities[i].w = velocities_before[i].w;
    if (scale.position == 1 && scale.velocity == 1 && scale.shift_rate == 0)
        return;
    const FinePosition from = FinePosition(before[i].xyz, unpack_residual(residuals_before[i]));
    const FinePosition to = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    const vec3 v = velocities_before[i].xyz;
    if (scale.position == 0 && scale.velocity == 0 && scale.shift_rate == 0) // what is undone may not be finite
    {
        positions[i].xyz = from.x;
        residuals[i] = pack_residual(from);
        velocities[i].xyz = v;
        return;
    }
    const vec3 shift = displacement(from, to);
    const FinePosition between = moved(from, scale.position * shift);
    positions[i].xyz = between.x;
    residuals[i] = pack_residual(between);
    velocities[i].xyz = v + scale.velocity * (velocities[i].xyz - v) + scale.shift_rate * shift;
}
