// The wind at a position: a steady vector and gusts that drift with it.
//
// The gusts are four transverse waves, an octave apart. The field has no divergence (Kraichnan 1970, "Diffusion by a
// random velocity field"). Amplitudes fall as k^(-1/3): an octave of Kolmogorov's spectrum, k^(-5/3) dk, has the energy
// k^(-2/3). The host computes the phases at the step's start in double precision. The field depends on time and
// position only.
// The including kernel declares `push` (StagePush).
#ifndef VOILE_WIND_GLSL
#define VOILE_WIND_GLSL

#include "shared/constants.glsl"
#include "shared/step_input.glsl"

// Wave vectors in units of the longest wave's, unit directions of the velocity across them, and amplitudes, whose root
// mean square is 1.
const vec3 k_gust_waves[4] = vec3[](VOILE_GUST_WAVES);
const vec3 k_gust_directions[4] = vec3[](vec3(0.5883, 0.1961, -0.7845), vec3(0.5699, 0.8206, -0.0420),
                                         vec3(0.6441, -0.0067, 0.7649), vec3(0.9487, 0.3162, 0));
const float k_gust_amplitudes[4] = float[](0.9372, 0.7439, 0.5904, 0.4686);

// The upper 12 bits of a float's 24, so that products of two such are exact.
float upper_half(float a)
{
    precise const float scaled = 4097 * a;
    precise const float upper = scaled - (scaled - a);
    return upper;
}

// The fractional turns of a b, a in turns/m, b in m. Far from the origin a float cannot represent the turns and a
// precise fraction, so the rounding error of the product is kept (Dekker 1971, "A floating-point technique for
// extending the available precision"). Not with fma, which may round twice in Vulkan.
float turns(float a, float b, float b_residual)
{
    const float a_upper = upper_half(a);
    const float b_upper = upper_half(b);
    precise const float a_lower = a - a_upper;
    precise const float b_lower = b - b_upper;
    precise const float product = a * b;
    precise const float rest =
        ((a_upper * b_upper - product) + a_upper * b_lower + a_lower * b_upper) + a_lower * b_lower;
    return fract(product) + (rest + a * b_residual);
}

// m/s, beyond the mean wind.
vec3 gust_at(FinePosition position)
{
    vec3 gust = vec3(0);
    if (push.gusts == 0)
        return gust;
    const vec4 phases = step_input.gust_phases + seconds(push.time) * step_input.gust_rates;
    for (int i = 0; i < 4; ++i)
    {
        const vec3 wave = step_input.gust_frequency * k_gust_waves[i];
        const float along = turns(wave.x, position.x.x, position.residual.x) + turns(wave.y, position.x.y, position.residual.y) +
                            turns(wave.z, position.x.z, position.residual.z);
        gust += step_input.gust_speed * k_gust_amplitudes[i] * sin(k_two_pi * fract(along - phases[i])) *
                k_gust_directions[i];
    }
    return gust;
}

#endif
