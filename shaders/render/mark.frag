#version 460
#extension GL_GOOGLE_include_directive : require
// One color. Round if there is an offset from the center.
#include "marks.glsl"

layout(location = 0) in vec2 offset;
layout(location = 0) out vec4 color;

void main()
{
    if (dot(offset, offset) > 1)
        discard;
    color = vec4(push.color, 1);
}
