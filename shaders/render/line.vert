#version 460
#extension GL_GOOGLE_include_directive : require
// One line per instance: two triangles, push.size pixels wide.
#include "marks.glsl"

layout(location = 0) in vec4 from;
layout(location = 1) in vec4 to; // the other end; if push.extent > 0, the direction to it
layout(location = 0) out vec2 out_offset;

void main()
{
    vec4 a = project_mark(from.xyz);
    vec4 b = project_mark(push.extent > 0 ? from.xyz + push.extent * to.xyz : to.xyz);
    out_offset = vec2(0);
    gl_Position = vec4(2, 2, 2, 1); // outside
    const float nearest = 1e-3 * frame.focus_radius;
    if (a.w < nearest && b.w < nearest)
        return;
    if (a.w < nearest)
        a = mix(a, b, (nearest - a.w) / (b.w - a.w));
    else if (b.w < nearest)
        b = mix(b, a, (nearest - b.w) / (a.w - b.w));
    const vec2 delta = (b.xy / b.w - a.xy / a.w) / push.pixel;
    const vec2 along = dot(delta, delta) > 0 ? normalize(delta) : vec2(1, 0);
    const float side = (0x2a >> gl_VertexIndex & 1) != 0 ? 0.5 : -0.5;
    gl_Position = (0x34 >> gl_VertexIndex & 1) != 0 ? b : a;
    gl_Position.xy += side * push.size * vec2(-along.y, along.x) * push.pixel * gl_Position.w;
}
