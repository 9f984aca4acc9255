#version 460
#extension GL_GOOGLE_include_directive : require
// The sky behind everything.
#include "frame.glsl"
#include "sky.glsl"
#include "tone.glsl"

layout(location = 0) in vec3 direction;
layout(location = 0) out vec4 color;

void main()
{
    color = vec4(tone_map(sky_radiance(normalize(direction), frame.to_sun)), 1);
}
