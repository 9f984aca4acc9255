#version 460
#extension GL_GOOGLE_include_directive : require
// Pins, once per step before its first substep. Sets each to its position and gives it the velocity that moves it along
// a straight line to its position at the step's end. One thread per pin. Anchors can jump and scale, so positions are
// clamped to their range. Pins of a disabled cloth stay where they are.
#include "shared/attachment_layout.h"
#include "shared/bindings.h"
#include "shared/cloth_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(attachments)) readonly buffer Attachments { AttachmentRecord attachments[]; };
layout(VOILE_BINDING(anchors)) readonly buffer Anchors { AnchorRecord anchors[]; };
layout(VOILE_BINDING(positions)) buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) writeonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(residuals)) writeonly buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { PinPush push; };

void main()
{
    if (gl_GlobalInvocationID.x >= push.count)
        return;
    const AttachmentRecord attachment = attachments[push.first + gl_GlobalInvocationID.x];
    if (push.step == 0)
    {
        positions[attachment.vertex].w = 0;
        velocities[attachment.vertex] = vec4(0);
        return;
    }
    const AnchorRecord anchor = anchors[attachment.anchor];
    const bool placed = (attachment.flags & VOILE_ATTACHMENT_PLACED) != 0;
    const vec3 bound = vec3(VOILE_MOST_COORDINATE);
    const vec3 from = placed ? clamp((anchor.from * vec4(attachment.position, 1)).xyz, -bound, bound) : positions[attachment.vertex].xyz;
    const vec3 to = clamp((placed ? anchor.to * vec4(attachment.position, 1) : anchor.motion * vec4(from, 1)).xyz, -bound, bound);
    positions[attachment.vertex] = vec4(from, 0);
    if (placed)
        residuals[attachment.vertex] = uvec2(0);
    velocities[attachment.vertex] = vec4((to - from) / push.step, 0);
}
