#version 460
#extension GL_GOOGLE_include_directive : require
// The angular velocity of each vertex's neighborhood after the passes of the strain limit on a softened cloth: that of
// the rigid motion about the vertex that is closest to the velocities of its neighbors, by least squares.
// limit_smooth.comp follows.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(step_velocities)) readonly buffer StepVelocities { vec4 step_velocities[]; };
layout(VOILE_BINDING(limit_vertices)) readonly buffer LimitVertices { LimitVertex limit_vertices[]; };
layout(VOILE_BINDING(limit_levels)) readonly buffer LimitLevels { LimitLevel limit_levels[]; };
layout(VOILE_BINDING(limit_links)) readonly buffer LimitLinks { LimitLink limit_links[]; };
// rad/s; w: the part of a relative velocity that the vertex may take.
layout(VOILE_BINDING(spins)) writeonly buffer Spins { vec4 spins[]; };

#include "shared/patch.glsl"
#include "constraints/limit_neighbors.glsl"

// rad/s: (inertia)^-1 moment. Where all neighbors lie in one line, a rotation about it moves none: the smallest axis of
// inertia is raised.
vec3 angular_velocity(mat3 inertia, vec3 moment)
{
    const float trace = inertia[0][0] + inertia[1][1] + inertia[2][2];
    if (!(trace > 0))
        return vec3(0);
    const float k_least = 1e-5;
    const mat3 a = inertia / trace + mat3(k_least);
    const mat3 adjugate = mat3(cross(a[1], a[2]), cross(a[2], a[0]), cross(a[0], a[1])); // of a symmetric matrix
    return adjugate * (moment / trace) / dot(a[0], adjugate[0]);
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!is_smoothed(self))
        return;
    const Neighborhood n = neighborhood(self);
    const VertexState own = state_of(self.index);
    mat3 inertia = mat3(0);
    vec3 moment = vec3(0);
    for (uint first = 0; first < n.count; first += VOILE_LEVEL_NEIGHBORS)
    {
        VertexState others[VOILE_LEVEL_NEIGHBORS];
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
            others[k] = state_of(neighbor_index(n, first + k));
        for (uint k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
        {
            const vec3 dx = others[k].x - own.x;
            const float weight = reduced_mass(own.inverse_mass, others[k].inverse_mass);
            inertia += weight * (mat3(dot(dx, dx)) - outerProduct(dx, dx));
            moment += weight * cross(dx, others[k].v - own.v);
        }
    }
    spins[self.index] = vec4(angular_velocity(inertia, moment), smoothing_part(n.count));
}
