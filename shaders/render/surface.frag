#version 460
#extension GL_GOOGLE_include_directive : require
// Shades a surface: sun with shadow, sky, and the patterns of fabric and ground. Writes tone-mapped color.
#include "brdf.glsl"
#include "fabric.glsl"
#include "frame.glsl"
#include "occlusion.glsl"
#include "quad.glsl"
#include "shadow.glsl"
#include "sky.glsl"
#include "strain.glsl"
#include "tone.glsl"

layout(push_constant, std430) uniform Push { DrawPush push; };
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec2 texture_coordinate;
layout(location = 0) out vec4 color;

struct Shading
{
    vec3 albedo;
    vec3 smooth_normal; // unit, on the viewer's side
    vec3 normal;        // tilted by the weave
    float roughness;
    float metallic;
    float sheen;
    float translucency; // fraction of the sun's light transmitted from the other side
};

// The normal tilted along the directions in which the texture coordinates grow (Mikkelsen 2010, without tangents).
vec3 tilt_normal(vec3 n, vec2 tilt)
{
    const vec3 dx = dFdx(world);
    const vec3 dy = dFdy(world);
    const vec2 ux = dFdx(texture_coordinate);
    const vec2 uy = dFdy(texture_coordinate);
    const vec3 across_y = cross(dy, n);
    const vec3 across_x = cross(n, dx);
    const vec3 tangent = across_y * ux.x + across_x * uy.x;
    const vec3 bitangent = across_y * ux.y + across_x * uy.y;
    const float size = max(dot(tangent, tangent), dot(bitangent, bitangent));
    return size > 0 ? normalize(n + inversesqrt(size) * (tilt.x * tangent + tilt.y * bitangent)) : n;
}

void apply_fabric(inout Shading s)
{
    const vec2 colors = yarn_pattern(push.pattern, push.pattern_scale * texture_coordinate);
    s.albedo *= 1 - 0.42 * colors.x;
    s.albedo = mix(s.albedo, k_light_yarn, 0.75 * colors.y);
    s.translucency = push.translucency;
    if (push.weave == VOILE_WEAVE_NONE)
        return;
    const Weave weave = push.weave == VOILE_WEAVE_GRAIN ? leather_grain(push.weave_scale * texture_coordinate)
                                                        : woven(push.weave, push.weave_scale * texture_coordinate);
    if (push.weave == VOILE_WEAVE_TWILL)
        s.albedo = mix(s.albedo, k_light_yarn, 0.3 * weave.weft);
    s.albedo *= 0.45 + 0.65 * weave.height;
    s.normal = tilt_normal(s.normal, weave.tilt);
}

// Joints between slabs, whose size follows the scene's.
void apply_ground(inout Shading s)
{
    const float slab = exp2(floor(log2(max(frame.focus_radius, 1e-3) * 0.4)));
    const vec2 p = world.xz / slab;
    const vec2 w = fwidth(p);
    const float joint = max(band(p.x, w.x, 0.02), band(p.y, w.y, 0.02));
    s.albedo *= 1 - 0.35 * joint;
}

vec3 sun_light(Shading s, vec3 v, float n_v, vec3 f0)
{
    const vec3 l = frame.to_sun;
    const float facing = dot(s.normal, l);
    // The shadow map has no weave, whose tilt would scatter the samples.
    const float smooth_side = dot(s.smooth_normal, l) >= 0 ? 1 : -1;
    const float visible = sun_visibility(world, smooth_side * s.smooth_normal);
    if (visible == 0)
        return vec3(0);
    const vec3 through = s.translucency * max(-facing, 0) / k_pi * s.albedo;
    const float n_l = max(facing, 0);
    const vec3 h = normalize(v + l);
    const float n_h = max(dot(s.normal, h), 0);
    const float alpha = s.roughness * s.roughness;
    const vec3 f = fresnel(f0, max(dot(v, h), 0));
    const vec3 specular = f * ggx_distribution(n_h, alpha) * ggx_visibility(n_l, n_v, alpha);
    const vec3 diffuse = (1 - f) * (1 - s.metallic) * s.albedo / k_pi;
    const vec3 sheen = s.sheen * sheen_lobe(n_h, n_l, n_v) * mix(s.albedo, vec3(1), 0.4);
    return visible * frame.sun_irradiance * ((diffuse + specular + sheen) * n_l + through);
}

vec3 sky_light(Shading s, vec3 v, float n_v, vec3 f0)
{
    const vec3 diffuse = (1 - s.metallic) * s.albedo * sky_diffuse(s.normal);
    const vec3 specular =
        environment_specular(f0, s.roughness, n_v) * sky_specular(reflect(-v, s.normal), s.roughness, frame.to_sun);
    const vec3 sheen = 0.35 * s.sheen * pow(max(1 - n_v, 0), 3) * mix(s.albedo, vec3(1), 0.4) * sky_diffuse(s.normal);
    return diffuse + specular + sheen;
}

void main()
{
    const vec3 v = normalize(frame.camera_position - world);
    Shading s;
    s.albedo = gl_FrontFacing ? push.base_color : push.back_color;
    s.smooth_normal = (gl_FrontFacing ? 1 : -1) * normalize(vertex_normal);
    s.normal = s.smooth_normal;
    s.roughness = max(push.roughness, 0.05);
    s.metallic = push.metallic;
    s.sheen = push.sheen;
    s.translucency = 0;
    if (push.kind == VOILE_SURFACE_FABRIC)
    {
        apply_fabric(s);
        if (frame.full_strain > 0)
            s.albedo = heat_color(largest_stretch(dFdx(world), dFdy(world), dFdx(texture_coordinate),
                                                  dFdy(texture_coordinate)) /
                                  frame.full_strain);
    }
    else if (push.kind == VOILE_SURFACE_GROUND)
        apply_ground(s);

    const float n_v = max(dot(s.normal, v), 1e-3);
    const vec3 f0 = mix(vec3(0.04), s.albedo, s.metallic);
    const float sky = quad_mean(sky_visibility(world, s.smooth_normal));
    vec3 radiance = sun_light(s, v, n_v, f0) + sky * sky_light(s, v, n_v, f0);
    if (push.kind == VOILE_SURFACE_GROUND)
    {
        const float d = distance(world.xz, frame.focus.xz) / frame.focus_radius;
        radiance = mix(radiance, sky_radiance(-v, frame.to_sun), smoothstep(1.6, 7, d));
    }
    color = vec4(tone_map(radiance), 1);
}
