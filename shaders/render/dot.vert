#version 460
#extension GL_GOOGLE_include_directive : require
// One dot per instance, push.size pixels wide. Hidden if push.mask is set and its flags have none of these bits.
#include "marks.glsl"

layout(location = 0) in vec4 position;
layout(location = 1) in vec4 value; // w: flags, a whole number
layout(location = 0) out vec2 out_offset;

void main()
{
    out_offset = vec2((0x2a >> gl_VertexIndex & 1) != 0 ? 1 : -1, (0x34 >> gl_VertexIndex & 1) != 0 ? 1 : -1);
    const bool shown = push.mask == 0 || (uint(value.w) & push.mask) != 0;
    gl_Position = shown ? project_mark(position.xyz) : vec4(2, 2, 2, 1);
    if (shown)
        gl_Position.xy += 0.5 * push.size * out_offset * push.pixel * gl_Position.w;
}
