// A clear sky by formulas: its color in a direction, and its light on a surface.
#ifndef VOILE_SKY_GLSL
#define VOILE_SKY_GLSL

const vec3 k_zenith = vec3(0.13, 0.23, 0.42);
const vec3 k_horizon = vec3(0.46, 0.56, 0.68);
const vec3 k_ground_bounce = vec3(0.15, 0.13, 0.11);

vec3 sky_radiance(vec3 direction, vec3 to_sun)
{
    const float height = max(direction.y, 0);
    const vec3 gradient = mix(k_horizon, k_zenith, 1 - exp(-3.5 * height));
    const float toward_sun = max(dot(direction, to_sun), 0);
    const vec3 glow = vec3(1.0, 0.85, 0.6) * (0.25 * pow(toward_sun, 24) + 0.12 * pow(toward_sun, 4));
    return gradient + glow;
}

// Irradiance over pi, from the sky above and from light that the ground reflects.
vec3 sky_diffuse(vec3 normal)
{
    const float up = 0.5 + 0.5 * normal.y;
    return mix(k_ground_bounce, mix(k_horizon, k_zenith, 0.6), up * up);
}

// The reflection in a rough mirror: the sky blurred towards its diffuse light, the ground below the horizon.
vec3 sky_specular(vec3 reflected, float roughness, vec3 to_sun)
{
    const vec3 sharp = mix(k_ground_bounce, sky_radiance(reflected, to_sun), smoothstep(-0.3, 0.2, reflected.y));
    return mix(sharp, sky_diffuse(reflected), roughness);
}

#endif
