#version 460
#extension GL_GOOGLE_include_directive : require
// One triangle that covers the picture at the far plane.
#include "frame.glsl"

layout(location = 0) out vec3 out_direction;

void main()
{
    const vec2 clip = vec2(gl_VertexIndex == 1 ? 3 : -1, gl_VertexIndex == 2 ? 3 : -1);
    const vec4 world = frame.world_from_clip * vec4(clip, 0, 1);
    out_direction = world.xyz / world.w - frame.camera_position;
    gl_Position = vec4(clip, 0, 1);
}
