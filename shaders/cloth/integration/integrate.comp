#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// One stage of the classical Runge-Kutta method (Kutta 1901) for the cloths that use it.
//
// A thread evaluates the acceleration of one vertex, or a part of a mesh's (mesh_forces.glsl), from the stage's positions
// and velocities of the vertex and of its neighbors, and writes the next stage's state. Stage 4 writes the result of the substep from the velocities of all
// stages. They are k1 to k4 of the positions, and their differences contain k1 to k3 of the velocities, so no stage
// stores sums. All stages share one kernel. Four kernels, each with the forces in it, are slower beside contact
// (bench/NOTES.md).
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/step_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(base_positions)) readonly buffer BasePositions { vec4 base_positions[]; }; // w: inverse mass, 1/kg
layout(VOILE_BINDING(base_velocities)) readonly buffer BaseVelocities { vec4 base_velocities[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 stage_positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 stage_velocities[]; };
layout(VOILE_BINDING(next_positions)) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(VOILE_BINDING(next_velocities)) writeonly buffer NextVelocities { vec4 next_velocities[]; }; // may be the third ones
layout(VOILE_BINDING(second_velocities)) readonly buffer SecondVelocities { vec4 second_velocities[]; }; // for stage 4
layout(VOILE_BINDING(third_velocities)) readonly buffer ThirdVelocities { vec4 third_velocities[]; };   // for stage 4
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_springs)) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(base_residuals)) readonly buffer BaseResiduals { uvec2 base_residuals[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 stage_residuals[]; };
layout(VOILE_BINDING(next_residuals)) writeonly buffer NextResiduals { uvec2 next_residuals[]; };
layout(VOILE_BINDING(membrane_corners)) readonly buffer MembraneCorners { MembraneCorner membrane_corners[]; };

layout(push_constant, std430) uniform Push { StagePush push; };

#define VOILE_SHARES_FORCES
#include "forces/forces.glsl"

FinePosition base_position(uint i)
{
    const vec3 x = base_positions[i].xyz;
    return FinePosition(x, unpack_residual(base_residuals[i]));
}

void write_position(uint i, FinePosition x, float inverse_mass)
{
    next_positions[i] = vec4(x.x, inverse_mass);
    next_residuals[i] = pack_residual(x);
}

void main()
{
    const PatchVertex own = patch_vertex(patch_of_batch(push.first_patch));
    if (is_idle(own))
        return;
    const PatchVertex self = force_vertex(own);
    const uint i = self.index;
    const vec4 stage_x = stage_positions[i];
    const vec3 stage_v = stage_velocities[i].xyz;
    const float inverse_mass = stage_x.w;
    const FinePosition here = FinePosition(stage_x.xyz, unpack_residual(stage_residuals[i]));
    // Stage 1's state is the base state: one read suffices. No branch around the gather: all loads are issued together.
    const FinePosition x = push.stage == 1 ? here : base_position(i);
    const vec3 v = push.stage == 1 ? stage_v : base_velocities[i].xyz;
    const vec3 forced = acceleration(false, self, here, inverse_mass, stage_v);
    if (!is_first(own))
        return;
    const vec3 a = inverse_mass > 0 ? forced : vec3(0);
    const float h = seconds(push.substeps);
    if (push.stage == 4)
    {
        const vec3 second = second_velocities[i].xyz;
        const vec3 third = third_velocities[i].xyz;
        write_position(i, moved(x, h / 6 * (v + 2 * (second + third) + stage_v)), inverse_mass);
        // h / 2 k1 + h k2 + h k3 + h / 2 k4, over 3
        const vec3 change = (second - v) + 2 * (third - v) + (stage_v - v) + 0.5 * h * a;
        next_velocities[i] = vec4(v + change / 3, 0);
        return;
    }
    const float time = push.stage == 3 ? h : 0.5 * h;
    write_position(i, moved(x, time * stage_v), inverse_mass);
    next_velocities[i] = vec4(v + time * a, 0);
}
