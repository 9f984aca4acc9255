#version 460
// An overlay's color, covered as its image says.

layout(set = 0, binding = 0) uniform sampler2D coverage;
layout(location = 0) in vec2 coordinate;
layout(location = 1) in vec4 in_color;
layout(location = 0) out vec4 color;

void main()
{
    color = vec4(in_color.rgb, in_color.a * texture(coverage, coordinate).r);
}
