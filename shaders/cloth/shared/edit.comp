#version 460
#extension GL_GOOGLE_include_directive : require
// Changes of a whole cloth by the host between two steps: masses by a new density, reset, teleport, velocity. One
// thread per vertex of that cloth.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/step_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; }; // w: inverse of what density multiplies
layout(VOILE_BINDING(positions)) buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(start_residuals)) readonly buffer StartResiduals { uvec2 start_residuals[]; };
layout(VOILE_BINDING(residuals)) buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { EditPush push; };

#include "shared/fine_position.glsl"

// Products and sums with their rounding errors. The errors are summed separately, because next to large numbers they
// would be lost.
FinePosition transformed(mat4 transform, FinePosition p)
{
    vec3 x = transform[3].xyz;
    vec3 residual = mat3(transform) * p.residual;
    for (int axis = 0; axis < 3; ++axis)
    {
        precise const vec3 product = transform[axis].xyz * p.x[axis];
        precise const vec3 rest = fma(transform[axis].xyz, vec3(p.x[axis]), -product);
        const FinePosition sum = moved(FinePosition(x, vec3(0)), product);
        x = sum.x;
        residual += sum.residual + rest;
    }
    return moved(FinePosition(x, vec3(0)), residual);
}

void main()
{
    const uint local = gl_GlobalInvocationID.x;
    if (local >= cloths[push.cloth].vertices)
        return;
    const uint i = cloths[push.cloth].first_vertex + local;
    const float inverse_mass = start[i].w * cloths[push.cloth].inverse_density;
    if (push.kind == VOILE_EDIT_MASSES)
    {
        // A heavier vertex keeps its momentum, a lighter one its velocity, so that kinetic energy never grows.
        const float before = positions[i].w;
        if (before > inverse_mass)
            velocities[i].xyz *= inverse_mass / before;
        positions[i].w = inverse_mass;
    }
    else if (push.kind == VOILE_EDIT_RESET)
    {
        positions[i] = vec4(start[i].xyz, inverse_mass);
        residuals[i] = start_residuals[i];
        velocities[i] = vec4(push.velocity, 0);
    }
    else if (push.kind == VOILE_EDIT_TRANSFORM)
    {
        const vec3 x = positions[i].xyz;
        const vec3 residual = unpack_residual(residuals[i]);
        FinePosition next = transformed(push.transform, FinePosition(x, residual));
        // Scales multiply from call to call. Clamped, the result stays within the ranges of the input.
        next.x = clamp(next.x, vec3(-VOILE_MOST_COORDINATE), vec3(VOILE_MOST_COORDINATE));
        const vec3 v = mat3(push.transform) * velocities[i].xyz;
        positions[i].xyz = next.x;
        residuals[i] = pack_residual(next);
        velocities[i] = vec4(clamp(v, vec3(-VOILE_MOST_SPEED), vec3(VOILE_MOST_SPEED)), 0);
    }
    else
        velocities[i] = vec4(push.velocity, 0);
}
