// The descriptor set of all of the renderer's shaders.
#ifndef VOILE_FRAME_GLSL
#define VOILE_FRAME_GLSL

#include "render_layout.h"

layout(set = 0, binding = 0, std140) uniform Frame { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = 2) uniform sampler2D shadow_depth; // the same image, without comparison
layout(set = 0, binding = 3) uniform sampler2D height_depth;

// Mesa's CPU device executes both sides of a branch, and ends a loop only if the number of its rounds is not known before.
layout(constant_id = 0) const bool k_is_cpu = false; // set by graphics_pipeline.cpp

// Of a loop that a pixel needs or not: as many on GPUs, so that they unroll it behind a branch.
int rounds(int count, bool needed) { return k_is_cpu && !needed ? 0 : count; }

// Both maps cover the sphere around the focus, 6 radii deep (Renderer::State::uniforms).
const float k_map_depth = 6;

// The first direction of a pattern of samples in this pixel (Jimenez 2014, "interleaved gradient noise").
vec2 pixel_direction(vec2 pixel)
{
    const float angle = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
    return vec2(cos(angle), sin(angle));
}

// The next direction: by the golden angle, which spreads points over a disc evenly (Vogel 1979).
vec2 next_direction(vec2 d) { return mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * d; }

#endif
