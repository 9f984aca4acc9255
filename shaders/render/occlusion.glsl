// The visible fraction of the sky at a point, from a map of heights.
#ifndef VOILE_OCCLUSION_GLSL
#define VOILE_OCCLUSION_GLSL

#include "frame.glsl"

// Columns of matter around the point hide the sky in their direction. What is behind the surface counts for nothing. Low
// ones count for less, and high ones, because light enters between the point and them.
float sky_visibility(vec3 world, vec3 normal)
{
    const int k_taps = 8;
    const float widest = 0.22 * frame.focus_radius; // m
    const vec3 lifted = world + 0.012 * frame.focus_radius * normal;
    const vec4 clip = frame.height_from_world * vec4(lifted, 1);
    const bool mapped = all(lessThanEqual(abs(clip.xy), vec2(1)));
    if (!mapped)
        return 1;
    vec2 around = pixel_direction(gl_FragCoord.xy);
    float hidden = 0;
    for (int i = 0; i < rounds(k_taps, mapped); ++i)
    {
        const vec2 offset = widest * (float(i) + 0.5) / k_taps * around; // denser near the point
        around = next_direction(around);
        const vec2 at = 0.5 * clip.xy + 0.5 + offset / (2 * frame.focus_radius);
        const float above = (clip.z - textureLod(height_depth, at, 0).r) * k_map_depth * frame.focus_radius;
        if (above <= 0)
            continue;
        const vec3 direction = normalize(vec3(offset.x, above, offset.y));
        const float near = widest * widest / (widest * widest + above * above);
        hidden += max(dot(direction, normal), 0) * min(4 * above / widest, 1) * near;
    }
    return 1 - 0.9 * hidden / k_taps;
}

#endif
