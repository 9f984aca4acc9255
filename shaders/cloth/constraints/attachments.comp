#version 460
#extension GL_GOOGLE_include_directive : require
// Soft attachments: springs, max-distance constraints and backstops, once per substep after integration. One thread per
// attachment.
//
// A spring is integrated by backward Euler, v' = v + h w (k (p - x - h (v' - v)) + c (u - v')), with p and u the
// position and velocity of its anchor point and w the inverse mass. The change of velocity moves the vertex for the
// drift time of its integrator, so that a vertex at rest stays at rest. Max-distance constraints and backstops project
// the position and remove the velocity that leads out.
//
// What springs balance must not leave a velocity. Verlet's last half kick is without the spring, so the vertex ends the
// step without it, as if it were taut. RK4's stages are without it, too: where the forces of the cloth change within a
// substep, the mean that moves the vertex differs from the one that accelerates it. So the more a spring holds its
// vertex, the more the vertex moves by the mean of its velocities before and after the substep instead.
#include "shared/attachment_layout.h"
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(attachments)) readonly buffer Attachments { AttachmentRecord attachments[]; };
layout(VOILE_BINDING(anchors)) readonly buffer Anchors { AnchorRecord anchors[]; };
layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(proposed_positions)) buffer ProposedPositions { vec4 positions[]; };
layout(VOILE_BINDING(proposed_velocities)) buffer ProposedVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(proposed_predicted)) buffer ProposedPredicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(VOILE_BINDING(proposed_residuals)) buffer ProposedResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(earlier_positions)) readonly buffer EarlierPositions { vec4 earlier_positions[]; };
layout(VOILE_BINDING(earlier_residuals)) readonly buffer EarlierResiduals { uvec2 earlier_residuals[]; };
layout(VOILE_BINDING(earlier_velocities)) readonly buffer EarlierVelocities { vec4 earlier_velocities[]; };

layout(push_constant, std430) uniform Push { AttachmentPush push; };

#include "shared/fine_position.glsl"
#include "shared/step_input.glsl"
#include "integration/integrator.glsl"

const float k_firm_grip = 0.05;

// Projects a vertex that is `outside` m beyond a bound back along n, and removes the velocity that leads out. False: it
// is inside.
bool keep_inside(inout vec3 shift, inout vec3 v, vec3 n, float outside, vec3 point_velocity)
{
    if (outside <= 0)
        return false;
    shift -= outside * n;
    v -= max(dot(v - point_velocity, n), 0) * n;
    return true;
}

// m: what is missing of the displacement at the mean of the velocities before and after the substep.
vec3 missing_displacement(uint i, FinePosition here, vec3 shift, vec3 v, float h)
{
    const FinePosition earlier = FinePosition(earlier_positions[i].xyz, unpack_residual(earlier_residuals[i]));
    return 0.5 * h * (earlier_velocities[i].xyz + v) - displacement(earlier, here) - shift;
}

// Whether the spring acts while lists last (pairs/clear.glsl).
bool is_firm(AttachmentRecord attachment, float w)
{
    const float t = step_input.list_time;
    return t * w * (attachment.damping + t * attachment.stiffness) > k_firm_grip;
}

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const AttachmentRecord attachment = attachments[push.first + gl_GlobalInvocationID.x];
    const vec4 position = positions[attachment.vertex];
    if (position.w == 0 || (cloths[attachment.cloth].flags & VOILE_CLOTH_ASLEEP) != 0)
        return;
    const AnchorRecord anchor = anchors[attachment.anchor];
    const vec3 from = (anchor.from * vec4(attachment.position, 1)).xyz;
    const vec3 to = (anchor.to * vec4(attachment.position, 1)).xyz;
    const vec3 point = mix(from, to, push.progress);
    const float h = seconds(push.substeps);
    const FinePosition here = FinePosition(position.xyz, unpack_residual(residuals[attachment.vertex]));
    const vec3 to_vertex = (position.xyz - point) + here.residual;
    vec3 shift = vec3(0); // m, of the vertex
    const vec4 velocity = velocities[attachment.vertex];
    vec3 v = velocity.xyz;

    const vec3 point_velocity = (to - from) * step_input.rate;
    const float stiffness = attachment.stiffness;
    const float w = position.w;
    const vec3 pull = stiffness * (h * v - to_vertex) + attachment.damping * point_velocity;
    const float grip = h * w * (attachment.damping + h * stiffness); // 0: the vertex is free
    const vec3 spring_velocity = (v + h * w * pull) / (1 + grip);
    const bool verlet = is_verlet(cloths[attachment.cloth].flags);
    shift += drift_time(verlet, h, 1) * (spring_velocity - v);
    v = spring_velocity;
    if (!verlet && grip > 0)
        shift += grip / (1 + grip) * missing_displacement(attachment.vertex, here, shift, v, h);

    const vec3 offset = to_vertex + shift;
    const float distance = length(offset);
    bool taut = false;
    if (distance > attachment.max_distance)
        taut = keep_inside(shift, v, offset / distance, distance - attachment.max_distance, point_velocity);
    const bool held = taut || is_firm(attachment, w);
    if ((attachment.flags & VOILE_ATTACHMENT_BACKSTOP) != 0)
    {
        const vec3 n = normalize(mat3(anchor.to) * attachment.normal);
        taut = keep_inside(shift, v, -n, -dot(to_vertex + shift, n) - attachment.backstop, point_velocity) || taut;
    }
    const FinePosition next = moved(here, shift);
    positions[attachment.vertex].xyz = next.x;
    residuals[attachment.vertex] = pack_residual(next);
    // After the strain limit (step 0) Verlet's last half kick is done, and the next step must not repeat it.
    const uint flags = (taut || grip > 0 ? VOILE_VERTEX_TAUT : 0) | (taut ? VOILE_VERTEX_BOUND : 0) |
                       (held ? VOILE_VERTEX_HELD : 0);
    velocities[attachment.vertex] = vec4(v, h > 0 ? uint(velocity.w) | flags : velocity.w);
    if (verlet)
        predicted[attachment.vertex].xyz += v - velocity.xyz;
}
