#version 460
#extension GL_GOOGLE_include_directive : require
// Vertices of an overlay, in pixels.
#include "render_layout.h"

layout(push_constant, std430) uniform Push { OverlayPush push; };
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 coordinate;
layout(location = 2) in vec4 color; // sRGB
layout(location = 0) out vec2 out_coordinate;
layout(location = 1) out vec4 out_color;

void main()
{
    out_coordinate = coordinate;
    out_color = vec4(pow(color.rgb, vec3(2.2)), color.a); // the target encodes sRGB
    gl_Position = vec4(push.scale * position - 1, 0, 1);
}
