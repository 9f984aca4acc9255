// Uniforms of a frame and push constants of a draw. One definition for GLSL and C++.
#ifndef VOILE_RENDER_LAYOUT_H
#define VOILE_RENDER_LAYOUT_H

#include "../shared_types.h"

#define VOILE_SURFACE_PLAIN 0u
#define VOILE_SURFACE_FABRIC 1u
#define VOILE_SURFACE_GROUND 2u

// How the threads of a fabric lie (Surface::Weave), and the pattern of their colors (Surface::Pattern).
#define VOILE_WEAVE_PLAIN 0u
#define VOILE_WEAVE_TWILL 1u
#define VOILE_WEAVE_SATIN 2u
#define VOILE_WEAVE_GRAIN 3u
#define VOILE_WEAVE_NONE 4u
#define VOILE_PATTERN_CHECK 0u
#define VOILE_PATTERN_STRIPES 1u
#define VOILE_PATTERN_NONE 2u

VOILE_SHARED_BEGIN(voile::engine)

struct FrameUniforms
{
    mat4 clip_from_world;
    mat4 world_from_clip;
    mat4 shadow_from_world; // clip space of the shadow map
    mat4 height_from_world; // clip space of the height map, which looks down
    vec3 camera_position;   // m
    float shadow_texel;     // m, the side of a texel of the shadow map
    vec3 to_sun;            // unit
    float shadow_step;      // 1 / the shadow map's resolution
    vec3 sun_irradiance;    // irradiance of a surface that faces the sun
    float focus_radius;     // m
    vec3 focus;             // m
    float full_strain;      // of fabric with the hottest color of the heat map; 0: no heat map
};

struct DrawPush
{
    mat4 world_from_model;
    vec3 base_color;
    float roughness;
    vec3 back_color;
    float metallic;
    float sheen;
    float weave_scale;
    float pattern_scale;
    uint kind;
    float translucency;
    uint weave;
    uint pattern;
};

// Lines and dots; as large as DrawPush at most.
struct MarkPush
{
    mat4 world_from_model;
    vec3 color;
    float size;   // pixels
    vec2 pixel;   // its width and height in clip space
    float extent; // m, along the directions in the second stream; 0: it holds ends
    uint mask;    // of flags; 0: all are shown
};

struct OverlayPush
{
    vec2 scale; // clip space per pixel
};

VOILE_SHARED_END

#endif
