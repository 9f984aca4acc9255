// The color of cloth: a pattern of colored yarns, and the threads or the grain if they are large enough to be visible.
// Every pattern is filtered by its footprint in the pixel, so that it fades into its mean and does not shimmer.
#ifndef VOILE_FABRIC_GLSL
#define VOILE_FABRIC_GLSL

#include "render_layout.h"

// The mean over a footprint of width w of a wave that is 1 in the first `duty` of each period (box filter, by its
// integral).
float band_integral(float x, float duty) { return floor(x) * duty + min(fract(x), duty); }

float band(float x, float w, float duty)
{
    w = max(w, 1e-4);
    return (band_integral(x + 0.5 * w, duty) - band_integral(x - 0.5 * w, duty)) / w;
}

const vec3 k_light_yarn = vec3(0.82, 0.78, 0.68);

// The fractions of yarn of the second color (x) and of the light thin stripe (y) at p, 0..1.
vec2 yarn_pattern(uint pattern, vec2 p)
{
    if (pattern == VOILE_PATTERN_NONE)
        return vec2(0);
    const vec2 w = fwidth(p);
    const float along = pattern == VOILE_PATTERN_CHECK ? 0.5 : 0; // the part of the yarns that run along y
    const float broad = (1 - along) * band(p.x, w.x, 0.5) + along * band(p.y, w.y, 0.5);
    const float thin = (1 - along) * band(p.x + 0.77, w.x, 0.05) + along * band(p.y + 0.77, w.y, 0.05);
    return vec2(broad, thin);
}

struct Weave
{
    vec2 tilt;    // of the normal along both texture axes
    float height; // 0 in the gaps, 1 on top of a thread
    float weft;   // the part of the weft that is seen
};

// 1 where the unit cells of p are large enough to be seen, 0 where they are not.
float visibility(vec2 p)
{
    const vec2 w = fwidth(p);
    return 1 - smoothstep(0.2, 0.5, max(w.x, w.y));
}

bool warp_is_on_top(uint weave, vec2 cell)
{
    if (weave == VOILE_WEAVE_TWILL)
        return mod(cell.x + cell.y, 4) >= 0.5;
    if (weave == VOILE_WEAVE_SATIN)
        return mod(cell.x + 2 * cell.y, 5) >= 0.5;
    return mod(cell.x + cell.y, 2) < 0.5;
}

Weave woven(uint weave, vec2 threads)
{
    const float visible = visibility(threads);
    const float weft = weave == VOILE_WEAVE_TWILL ? 0.25 : weave == VOILE_WEAVE_SATIN ? 0.2 : 0.5;
    Weave result = Weave(vec2(0), 0.8, weft);
    if (visible == 0)
        return result;
    const vec2 cell = floor(threads);
    const vec2 local = fract(threads) - 0.5;
    const bool warp_on_top = warp_is_on_top(weave, cell);
    const vec2 across = warp_on_top ? vec2(local.x, 0) : vec2(0, local.y);
    const vec2 along = warp_on_top ? vec2(0, local.y) : vec2(local.x, 0);
    const float relief = weave == VOILE_WEAVE_SATIN ? 0.4 : 1; // threads that float lie flat
    result.tilt = visible * relief * (1.1 * across + 0.5 * along);
    result.height = mix(result.height, 1 - 2.2 * relief * dot(local, local), visible);
    result.weft = mix(weft, warp_on_top ? 0 : 1, visible);
    return result;
}

// Two numbers in 0..1 for a cell (Jarzynski and Olano 2020, "Hash functions for GPU rendering": pcg2d).
vec2 random_of(vec2 cell)
{
    uvec2 v = uvec2(ivec2(cell)) * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16;
    return vec2(v >> 8) / 16777216.0;
}

// Pebbles around scattered points (Worley 1996, "A cellular texture basis function"), two threads wide.
Weave leather_grain(vec2 threads)
{
    const vec2 p = threads / 2;
    const float visible = visibility(p);
    Weave grain = Weave(vec2(0), 0.85, 0);
    if (visible == 0)
        return grain;
    const vec2 cell = floor(p);
    vec2 nearest = vec2(2);
    for (int k = 0; k < 9; ++k)
    {
        const vec2 other = cell + vec2(k % 3 - 1, k / 3 - 1);
        const vec2 apart = p - other - random_of(other);
        nearest = dot(apart, apart) < dot(nearest, nearest) ? apart : nearest;
    }
    grain.tilt = visible * 0.7 * nearest;
    grain.height = mix(grain.height, 1 - 0.6 * dot(nearest, nearest), visible);
    return grain;
}

#endif
