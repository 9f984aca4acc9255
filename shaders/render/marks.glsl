// What lines and dots share: their push constants, and where a point lies in the picture.
#ifndef VOILE_MARKS_GLSL
#define VOILE_MARKS_GLSL

#include "frame.glsl"

layout(push_constant, std430) uniform Push { MarkPush push; };

// A little nearer to the camera on the same line of sight: marks that lie on a surface show.
vec4 project_mark(vec3 position)
{
    const vec3 world = (push.world_from_model * vec4(position, 1)).xyz;
    return frame.clip_from_world * vec4(mix(world, frame.camera_position, 0.004), 1);
}

#endif
