#version 460
#extension GL_GOOGLE_include_directive : require
// Depth of a drawable seen from above.
#include "frame.glsl"

layout(push_constant, std430) uniform Push { DrawPush push; };
layout(location = 0) in vec4 position;

void main()
{
    gl_Position = frame.height_from_world * (push.world_from_model * vec4(position.xyz, 1));
}
