// The descriptor set of all of the renderer's shaders.
#ifndef VOILE_FRAME_GLSL
#define VOILE_FRAME_GLSL

#include "render_layout.h"

layout(set = 0, binding = 0, std140) uniform Frame { FrameUniforms frame; };
layout(set = 0, binding = 1) uniform sampler2DShadow shadow_map;

#endif
