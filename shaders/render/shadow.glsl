// The visible fraction of the sun at a point: 1 in the open, 0 in full shadow.
#ifndef VOILE_SHADOW_GLSL
#define VOILE_SHADOW_GLSL

#include "frame.glsl"

// Percentage-closer filtering (Reeves, Salesin and Cook 1987) over a disc of 12 bilinear comparisons, spread evenly by
// the golden angle (Vogel 1979).
float sun_visibility(vec3 world, vec3 normal_to_sun)
{
    // Offset from the surface by a little more than the filter's radius on a tilted plane, so that it does not shade
    // itself.
    const vec3 lifted = world + (2.5 * frame.shadow_texel) * normal_to_sun;
    const vec4 clip = frame.shadow_from_world * vec4(lifted, 1);
    if (any(greaterThan(abs(clip.xy), vec2(1))) || clip.z >= 1)
        return 1;
    const vec2 center = 0.5 * clip.xy + 0.5;
    float lit = 0;
    for (int i = 0; i < 12; ++i)
    {
        const float radius = 3.2 * frame.shadow_step * sqrt((float(i) + 0.5) / 12);
        const float angle = float(i) * 2.39996323;
        lit += textureLod(shadow_map, vec3(center + radius * vec2(cos(angle), sin(angle)), clip.z), 0);
    }
    return lit / 12;
}

#endif
