#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The energy that a step, or the strain limit with its contact pass, adds to each cloth. Per patch: the energy of the
// springs in one of the two states, the work of all conservative forces in that state along the displacements between
// the states, and the terms of the kinetic energy.
//
// The kernel runs once per state. The energy of springs follows from their lengths. For bending and gravity the mean of
// the work in both states is exact.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/step_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 stage_positions[]; }; // where forces are taken
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 stage_velocities[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 stage_residuals[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_springs)) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(before_positions)) readonly buffer BeforePositions { vec4 before[]; };
layout(VOILE_BINDING(before_velocities)) readonly buffer BeforeVelocities { vec4 velocities_before[]; };
layout(VOILE_BINDING(before_residuals)) readonly buffer BeforeResiduals { uvec2 residuals_before[]; };
layout(VOILE_BINDING(after_positions)) readonly buffer AfterPositions { vec4 after[]; };
layout(VOILE_BINDING(after_velocities)) readonly buffer AfterVelocities { vec4 velocities_after[]; };
layout(VOILE_BINDING(after_residuals)) readonly buffer AfterResiduals { uvec2 residuals_after[]; };
layout(VOILE_BINDING(works)) writeonly buffer Works { LimitWork works[]; };
layout(VOILE_BINDING(step_start_positions)) readonly buffer StepStartPositions { vec4 step_start[]; };
layout(VOILE_BINDING(step_start_residuals)) readonly buffer StepStartResiduals { uvec2 step_start_residuals[]; };
layout(VOILE_BINDING(membrane_corners)) readonly buffer MembraneCorners { MembraneCorner membrane_corners[]; };

layout(push_constant, std430) uniform Push { StagePush push; }; // without air

#include "forces/forces.glsl"
#include "integration/integrator.glsl"

shared LimitWork sums[gl_WorkGroupSize.x];

// Without damping, with the scaled stiffness of the substeps.
struct Conservative
{
    float energy; // J, the vertex's part of the springs' energy
    vec3 springs; // N
    vec3 linear;  // N, bending and gravity
};

Conservative conservative_forces(PatchVertex self, FinePosition x, float mass)
{
    const uint cloth = self.cloth;
    const bool verlet = is_verlet(cloths[cloth].flags);
    StabilityScales scales = scales_of(verlet, cloth, seconds(push.substeps));
    scales.damping = scales.retardation = 0;
    const Gather g = gather(self, x, vec3(0), vec3(0), k_no_viscosity, scales);
    precise const vec3 gravity = cloths[cloth].gravity_scale * step_input.gravity;
    return Conservative(g.energy, g.force, g.bending + mass * gravity);
}

LimitWork add(LimitWork a, LimitWork b)
{
    return LimitWork(a.energy + b.energy, a.work + b.work, a.linear_work + b.linear_work, a.v_dv + b.v_dv,
                     a.dv_dv + b.dv_dv, a.v_dx + b.v_dx, a.dx_dx + b.dx_dx, a.dv_dx + b.dv_dx, a.undone + b.undone);
}

LimitWork work_of(PatchVertex self)
{
    const uint i = self.index;
    if (!self.exists || self.asleep || cloths[self.cloth].strain_limit == 0)
        return LimitWork(0, 0, 0, 0, 0, 0, 0, 0, 0);
    const FinePosition from = FinePosition(before[i].xyz, unpack_residual(residuals_before[i]));
    const FinePosition to = FinePosition(after[i].xyz, unpack_residual(residuals_after[i]));
    const FinePosition here = FinePosition(stage_positions[i].xyz, unpack_residual(stage_residuals[i]));
    const vec3 dx = displacement(from, to);
    const float inverse_mass = before[i].w;
    const float mass = inverse_mass == 0 ? 0 : 1 / inverse_mass;
    const Conservative c = conservative_forces(self, here, mass);
    if (inverse_mass == 0) // a pinned vertex: whatever moves it does work against its springs
        return LimitWork(c.energy, 0, -dot(c.springs, dx), 0, 0, 0, 0, 0, 0);
    const FinePosition start = FinePosition(step_start[i].xyz, unpack_residual(step_start_residuals[i]));
    const vec3 v = velocities_before[i].xyz;
    const vec3 dv = velocities_after[i].xyz - v;
    return LimitWork(c.energy, dot(c.springs + c.linear, dx), dot(c.linear, dx), mass * dot(v, dv), mass * dot(dv, dv),
                     mass * dot(v, dx), mass * dot(dx, dx), mass * dot(dv, dx),
                     -mass * dot(dx, displacement(start, from)));
}

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    const uint thread = gl_LocalInvocationID.x;
    sums[thread] = work_of(self);
    barrier();
    for (uint half_size = gl_WorkGroupSize.x / 2; half_size > 0; half_size /= 2)
    {
        if (thread < half_size)
            sums[thread] = add(sums[thread], sums[thread + half_size]);
        barrier();
    }
    if (thread == 0)
        works[push.first_patch + gl_WorkGroupID.x] = sums[0];
}
