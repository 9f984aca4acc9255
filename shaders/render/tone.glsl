// Scene radiance to display values. Applied to every sample, so that bright edges are antialiased as displayed.
#ifndef VOILE_TONE_GLSL
#define VOILE_TONE_GLSL

// A filmic curve: the fit of the ACES reference by Narkowicz 2015. Linear in and out: the target encodes sRGB.
vec3 tone_map(vec3 radiance)
{
    const vec3 x = 0.6 * radiance;
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0, 1);
}

#endif
