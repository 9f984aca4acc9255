// The color of woven cloth: a check of colored yarns, and the threads themselves if they are large enough to be visible.
// Every pattern is filtered by its footprint in the pixel, so that it fades into its mean and does not shimmer.
#ifndef VOILE_FABRIC_GLSL
#define VOILE_FABRIC_GLSL

// The mean over a footprint of width w of a wave that is 1 in the first `duty` of each period (box filter, by its
// integral).
float band_integral(float x, float duty) { return floor(x) * duty + min(fract(x), duty); }

float band(float x, float w, float duty)
{
    w = max(w, 1e-4);
    return (band_integral(x + 0.5 * w, duty) - band_integral(x - 0.5 * w, duty)) / w;
}

// The fractions of yarn of the second color (x) and of the light thin stripe (y) at p, 0..1.
vec2 check_pattern(vec2 p)
{
    const vec2 w = fwidth(p);
    const float broad = 0.5 * (band(p.x, w.x, 0.5) + band(p.y, w.y, 0.5));
    const float thin = 0.5 * (band(p.x + 0.77, w.x, 0.05) + band(p.y + 0.77, w.y, 0.05));
    return vec2(broad, thin);
}

struct Weave
{
    vec2 tilt;    // of the normal along both texture axes
    float height; // 0 in the gaps, 1 on top of a thread
};

// Plain weave: warp and weft alternate.
Weave plain_weave(vec2 threads)
{
    const vec2 w = fwidth(threads);
    const float visible = 1 - smoothstep(0.2, 0.5, max(w.x, w.y));
    Weave weave = Weave(vec2(0), 0.8);
    if (visible == 0)
        return weave;
    const vec2 cell = floor(threads);
    const vec2 local = fract(threads) - 0.5;
    const bool warp_on_top = mod(cell.x + cell.y, 2) < 0.5;
    const vec2 across = warp_on_top ? vec2(local.x, 0) : vec2(0, local.y);
    const vec2 along = warp_on_top ? vec2(0, local.y) : vec2(local.x, 0);
    weave.tilt = visible * (1.1 * across + 0.5 * along);
    const float top = 1 - 2.2 * dot(local, local);
    weave.height = mix(weave.height, top, visible);
    return weave;
}

#endif
