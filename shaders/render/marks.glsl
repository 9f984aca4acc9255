// Common to lines and dots: push constants, and the projection of a point.
#ifndef VOILE_MARKS_GLSL
#define VOILE_MARKS_GLSL

#include "frame.glsl"

layout(push_constant, std430) uniform Push { MarkPush push; };

// Slightly closer to the camera along the line of sight, so that marks on a surface are visible.
vec4 project_mark(vec3 position)
{
    const vec3 world = (push.world_from_model * vec4(position, 1)).xyz;
    return frame.clip_from_world * vec4(mix(world, frame.camera_position, 0.004), 1);
}

#endif
