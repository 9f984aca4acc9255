#version 460
#extension GL_GOOGLE_include_directive : require
// One dot per instance, like dot.vert, with its flags in a word.
#include "dots.glsl"

layout(location = 0) in vec4 position;
layout(location = 1) in uint flags;
layout(location = 0) out vec2 out_offset;

void main()
{
    out_offset = dot_corner();
    gl_Position = project_dot(position.xyz, flags);
}
