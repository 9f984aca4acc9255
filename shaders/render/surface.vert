#version 460
#extension GL_GOOGLE_include_directive : require
// Vertices of a drawable, from three streams.
#include "frame.glsl"

layout(push_constant, std430) uniform Push { DrawPush push; };
layout(location = 0) in vec4 position; // w: ignored (a cloth keeps its inverse masses there)
layout(location = 1) in vec4 normal;
layout(location = 2) in vec2 texture_coordinate;

layout(location = 0) out vec3 out_world;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec2 out_texture_coordinate;

void main()
{
    const vec4 world = push.world_from_model * vec4(position.xyz, 1);
    const mat3 m = mat3(push.world_from_model);
    // Normals transform by the cofactor matrix, which is the inverse transpose up to a factor.
    const mat3 cofactor = mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1]));
    out_world = world.xyz;
    out_normal = cofactor * normal.xyz;
    out_texture_coordinate = texture_coordinate;
    gl_Position = frame.clip_from_world * world;
}
