#version 460
// The edges of triangles.

layout(location = 0) out vec4 color;

void main()
{
    color = vec4(0.01, 0.015, 0.02, 1);
}
