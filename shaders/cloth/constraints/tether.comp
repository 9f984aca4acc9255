#version 460
#extension GL_GOOGLE_include_directive : require
// Tethers, once per substep after integration: no vertex moves farther from its pins than the length of the cloth
// between them.
// One thread per vertex with tethers. Pins have none, so no thread reads what another one writes.
//
// A vertex that is farther away already moves no farther, and its springs bring it back. Pulled back at once, it would
// load the springs with more energy than the cloth has.
//
// If two pins are farther apart than both tethers together, no position satisfies both. Both tethers then grow in
// proportion until they meet, so that the vertex comes to rest and is not pulled to the last one.
// Source: Kim, Chentanez and Müller 2012, "Long range attachments".
#include "shared/attachment_layout.h"
#include "shared/bindings.h"
#include "shared/cloth_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(tethers)) readonly buffer Tethers { TetherRecord tethers[]; };
layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(proposed_positions)) buffer ProposedPositions { vec4 positions[]; };
layout(VOILE_BINDING(proposed_velocities)) buffer ProposedVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(proposed_predicted)) buffer ProposedPredicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(VOILE_BINDING(proposed_residuals)) writeonly buffer ProposedResiduals { uvec2 residuals[]; };

layout(VOILE_BINDING(earlier_positions)) readonly buffer EarlierPositions { vec4 state_positions[]; }; // before the substep

layout(push_constant, std430) uniform Push { AttachmentPush push; };

#include "integration/integrator.glsl"

// m: the tether's length, extended if another pin is too far away, or if the vertex was.
float length_of(TetherRecord tether, uint t, vec3 pin)
{
    const float before = distance(state_positions[tether.vertex].xyz, state_positions[tether.pins[t]].xyz);
    float growth = 1;
    for (uint other = 0; other < tether.count; ++other)
    {
        const float both = tether.lengths[t] + tether.lengths[other];
        if (other != t)
            growth = max(growth, distance(pin, positions[tether.pins[other]].xyz) / both);
    }
    return max(growth * tether.lengths[t], before);
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const TetherRecord tether = tethers[push.first + gl_GlobalInvocationID.x];
    const vec3 start = positions[tether.vertex].xyz;
    const vec4 before = velocities[tether.vertex];
    if (positions[tether.vertex].w == 0 || (cloths[tether.cloth].flags & VOILE_CLOTH_ASLEEP) != 0)
        return;
    vec3 shift = vec3(0); // m
    vec3 v = before.xyz;
    bool taut = false;
    for (uint t = 0; t < tether.count; ++t)
    {
        const vec3 pin = positions[tether.pins[t]].xyz;
        const vec3 offset = (start - pin) + shift;
        const float distance = length(offset);
        const float longest = length_of(tether, t, pin);
        if (distance <= longest)
            continue;
        const vec3 n = offset / distance;
        shift -= (distance - longest) * n;
        v -= max(dot(v - velocities[tether.pins[t]].xyz, n), 0) * n;
        taut = true;
    }
    if (!taut)
        return;
    positions[tether.vertex].xyz = start + shift;
    residuals[tether.vertex] = uvec2(0);
    // After the strain limit (step 0) Verlet's last half kick is done, and the next step must not repeat it.
    velocities[tether.vertex] = vec4(v, push.substeps > 0 ? uint(before.w) | VOILE_VERTEX_TAUT | VOILE_VERTEX_BOUND : before.w);
    if (is_verlet(cloths[tether.cloth].flags))
        predicted[tether.vertex].xyz += v - before.xyz;
}
