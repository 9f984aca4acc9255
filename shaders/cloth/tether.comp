#version 460
#extension GL_GOOGLE_include_directive : require
// Tethers, once a substep after integration: no vertex goes farther from its pins than the way over the cloth. One thread a
// vertex that has any; pins have none, so that nobody reads what another thread writes.
// Source: Kim, Chentanez and Müller 2012, "Long range attachments". Reads: tethers, cloths. Writes: proposed state,
// predicted velocities.
#include "cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Tethers { TetherRecord tethers[]; };
layout(set = 0, binding = 1, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 2, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 4, std430) buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(set = 0, binding = 5, std430) writeonly buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { HoldPush push; };

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const TetherRecord tether = tethers[push.first + gl_GlobalInvocationID.x];
    vec3 x = positions[tether.vertex].xyz;
    const vec3 before = velocities[tether.vertex].xyz;
    vec3 v = before;
    bool taut = false;
    for (uint t = 0; t < tether.count; ++t)
    {
        const vec3 offset = x - positions[tether.pins[t]].xyz;
        const float distance = length(offset);
        if (distance <= tether.lengths[t])
            continue;
        const vec3 n = offset / distance;
        x -= (distance - tether.lengths[t]) * n;
        v -= max(dot(v - velocities[tether.pins[t]].xyz, n), 0) * n;
        taut = true;
    }
    if (!taut || positions[tether.vertex].w == 0)
        return;
    positions[tether.vertex].xyz = x;
    residuals[tether.vertex] = uvec2(0);
    velocities[tether.vertex].xyz = v;
    if ((cloths[tether.cloth].flags & VOILE_CLOTH_VERLET) != 0)
        predicted[tether.vertex].xyz += v - before;
}
