// Reflectance: metallic-roughness (GGX) with a layer of sheen.
#ifndef VOILE_BRDF_GLSL
#define VOILE_BRDF_GLSL

const float k_pi = 3.14159265;

// Schlick 1994.
vec3 fresnel(vec3 f0, float cosine) { return f0 + (1 - f0) * pow(max(1 - cosine, 0), 5); }

// Trowbridge-Reitz distribution, and Smith's height-correlated visibility (Heitz 2014), which includes 1 / (4 NoL NoV).
float ggx_distribution(float n_h, float alpha)
{
    const float a2 = alpha * alpha;
    const float d = max(n_h * n_h * (a2 - 1) + 1, 1e-7);
    return a2 / (k_pi * d * d);
}

float ggx_visibility(float n_l, float n_v, float alpha)
{
    const float a2 = alpha * alpha;
    const float l = n_v * sqrt(n_l * n_l * (1 - a2) + a2);
    const float v = n_l * sqrt(n_v * n_v * (1 - a2) + a2);
    return 0.5 / max(l + v, 1e-5);
}

// Fibers that protrude from the surface: the inverted Gaussian-like distribution of Estevez and Kulla 2017 ("Production
// friendly microfacet sheen BRDF") with the visibility of Neubelt and Pettineo 2013.
float sheen_lobe(float n_h, float n_l, float n_v)
{
    const float inverse_roughness = 1 / 0.45;
    const float sine = sqrt(max(1 - n_h * n_h, 0));
    const float distribution = (2 + inverse_roughness) * pow(sine, inverse_roughness) / (2 * k_pi);
    return distribution / (4 * (n_l + n_v - n_l * n_v) + 1e-4);
}

// Analytic fit of the environment's split sum for GGX (Karis 2014, "Physically based shading on mobile").
vec3 environment_specular(vec3 f0, float roughness, float n_v)
{
    const vec4 r = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    const float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    const vec2 scale_bias = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * scale_bias.x + scale_bias.y;
}

#endif
