// The wind at a place: a steady vector and gusts that drift with it.
//
// The gusts are four transverse waves, so that the field has no divergence (Kraichnan 1970, "Diffusion by a random
// velocity field"), an octave apart. Their amplitudes fall as k^(-1/3): an octave of Kolmogorov's spectrum, k^(-5/3) dk,
// has the energy k^(-2/3). Their phases at the present time come from the host, which reduces them in double precision.
// The field is a function of time and place alone. The including kernel declares `push` (StagePush).
#ifndef VOILE_WIND_GLSL
#define VOILE_WIND_GLSL

// Wave vectors in units of the longest wave's; the unit directions that the air swings in, across them; and amplitudes
// whose root mean square is 1 together.
const vec3 k_gust_waves[4] = vec3[](VOILE_GUST_WAVES);
const vec3 k_gust_directions[4] = vec3[](vec3(0.5883, 0.1961, -0.7845), vec3(0.5699, 0.8206, -0.0420),
                                         vec3(0.6441, -0.0067, 0.7649), vec3(0.9487, 0.3162, 0));
const float k_gust_amplitudes[4] = float[](0.9372, 0.7439, 0.5904, 0.4686);

vec3 wind_at(vec3 place)
{
    vec3 wind = push.wind;
    if (push.gust_speed == 0)
        return wind;
    for (int i = 0; i < 4; ++i)
    {
        const float phase = push.gust_wavenumber * dot(k_gust_waves[i], place) - push.gust_phases[i];
        wind += push.gust_speed * k_gust_amplitudes[i] * sin(phase) * k_gust_directions[i];
    }
    return wind;
}

#endif
