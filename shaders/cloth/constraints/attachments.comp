#version 460
#extension GL_GOOGLE_include_directive : require
// Soft attachments: springs, max-distance constraints and backstops, once per substep after integration. One thread per
// attachment.
//
// A spring is integrated by backward Euler, v' = v + h w (k (p - x - h (v' - v)) + c (u - v')), with p and u the
// position and velocity of its anchor point and w the inverse mass. The change of velocity moves the vertex for the
// drift time of its integrator, so that a vertex at rest stays at rest. Max-distance constraints and backstops project
// the position and remove the velocity that leads out.
// Reads: attachments, anchors, cloths. Writes: proposed state and residuals, predicted velocities.
#include "shared/attachment_layout.h"
#include "shared/cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Holds { AttachmentRecord holds[]; };
layout(set = 0, binding = 1, std430) readonly buffer Anchors { AnchorRecord anchors[]; };
layout(set = 0, binding = 2, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 3, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 4, std430) buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 5, std430) buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(set = 0, binding = 6, std430) buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { AttachmentPush push; };

#include "shared/fine_position.glsl"
#include "integration/integrator.glsl"

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

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const AttachmentRecord hold = holds[push.first + gl_GlobalInvocationID.x];
    const vec4 position = positions[hold.vertex];
    if (position.w == 0)
        return;
    const AnchorRecord anchor = anchors[hold.anchor];
    const vec3 from = (anchor.from * vec4(hold.place, 1)).xyz;
    const vec3 to = (anchor.to * vec4(hold.place, 1)).xyz;
    const vec3 point = mix(from, to, push.progress);
    const float h = push.step;
    const FinePosition here = FinePosition(position.xyz, unpack_residual(residuals[hold.vertex]));
    const vec3 to_vertex = (position.xyz - point) + here.residual;
    vec3 shift = vec3(0); // m, of the vertex
    const vec4 velocity = velocities[hold.vertex];
    vec3 v = velocity.xyz;

    const vec3 point_velocity = (to - from) * push.rate;
    const float stiffness = hold.stiffness;
    const float w = position.w;
    const vec3 pull = stiffness * (h * v - to_vertex) + hold.damping * point_velocity;
    const vec3 spring_velocity = (v + h * w * pull) / (1 + h * w * (hold.damping + h * stiffness));
    const bool verlet = is_verlet(cloths[hold.cloth].flags);
    shift += drift_time(verlet, h) * (spring_velocity - v);
    v = spring_velocity;

    const vec3 offset = to_vertex + shift;
    const float distance = length(offset);
    bool taut = false;
    if (distance > hold.max_distance)
        taut = keep_inside(shift, v, offset / distance, distance - hold.max_distance, point_velocity);
    if ((hold.flags & VOILE_ATTACHMENT_BACKSTOP) != 0)
    {
        const vec3 n = normalize(mat3(anchor.to) * hold.normal);
        taut = keep_inside(shift, v, -n, -dot(to_vertex + shift, n) - hold.backstop, point_velocity) || taut;
    }
    const FinePosition next = moved(here, shift);
    positions[hold.vertex].xyz = next.x;
    residuals[hold.vertex] = pack_residual(next);
    // After the strain limit (step 0) Verlet's last half kick is done, and the next step must not repeat it.
    velocities[hold.vertex] = vec4(v, taut && h > 0 ? uint(velocity.w) | VOILE_VERTEX_TAUT : velocity.w);
    if (verlet)
        predicted[hold.vertex].xyz += v - velocity.xyz;
}
