// The visible fraction of the sun at a point: 1 in the open, 0 in full shadow.
#ifndef VOILE_SHADOW_GLSL
#define VOILE_SHADOW_GLSL

#include "frame.glsl"
#include "quad.glsl"

const int k_blocker_taps = 16;
const int k_shadow_taps = 24;
const float k_sun_tangent = 0.03;  // of half the angle under which the sun is seen; that of the real one is 0.0047
const float k_widest_shadow = 30;  // texels, radius of the widest penumbra
const float k_narrowest_shadow = 1.6;

// Where a point is in the shadow map, and how the depth of its surface grows along the map.
struct ShadowPoint
{
    vec2 at;
    float depth;
    vec2 slope; // depth per coordinate
    vec2 direction; // of the first tap
};

ShadowPoint shadow_point(vec3 world, vec3 normal_to_sun)
{
    // Offset from the surface, so that it does not shade itself.
    const vec3 lifted = world + (1.5 * frame.shadow_texel) * normal_to_sun;
    const vec4 clip = frame.shadow_from_world * vec4(lifted, 1);
    // The plane through the point: n . d = 0 in the world, where clip space is scaled by 1 / (radius, radius, depth).
    const vec3 n = mat3(frame.shadow_from_world) * normal_to_sun;
    const float steep = max(-n.z * k_map_depth * frame.focus_radius, 0.25); // the cosine of the angle to the sun
    const vec2 across = n.xy * frame.focus_radius;
    ShadowPoint result;
    result.at = 0.5 * clip.xy + 0.5;
    result.depth = clip.z;
    result.slope = 2 * across / (steep * k_map_depth);
    result.direction = pixel_direction(gl_FragCoord.xy);
    return result;
}

// The mean distance along the map from the surface to what is between it and the sun; -1 if nothing is, and 0 if all of
// it is at the point itself. The taps miss cloth that lies on a round body: away from the point, the plane is above both.
float find_blockers(ShadowPoint p, bool mapped)
{
    const bool shaded = textureLod(shadow_map, vec3(p.at, p.depth), 0) < 1;
    vec2 sum = vec2(0);
    vec2 direction = p.direction;
    for (int i = 0; i < rounds(k_blocker_taps, mapped); ++i)
    {
        const float radius = k_widest_shadow * frame.shadow_step * sqrt((float(i) + 0.5) / k_blocker_taps);
        const vec2 offset = radius * direction;
        direction = next_direction(direction);
        const float above = p.depth + dot(p.slope, offset) - textureLod(shadow_depth, p.at + offset, 0).r;
        sum += above > 2e-4 ? vec2(above, 1) : vec2(0);
    }
    return shaded || sum.y > 0 ? sum.x / max(sum.y, 1) : -1;
}

struct SunVisibility
{
    float fraction;
    float width; // m, radius of the penumbra
};

// Percentage-closer soft shadows (Fernando 2005): the distance of what casts the shadow gives the width of the filter
// (Reeves, Salesin and Cook 1987). Hard at contact.
SunVisibility sample_sun(vec3 world, vec3 normal_to_sun)
{
    const ShadowPoint p = shadow_point(world, normal_to_sun);
    const bool mapped = all(lessThanEqual(abs(p.at - 0.5), vec2(0.5))) && p.depth < 1;
    if (!mapped)
        return SunVisibility(1, 0);
    const float above = find_blockers(p, mapped);
    if (above < 0)
        return SunVisibility(1, 0);
    // Texels: a map of 2 radii shows a depth of 6.
    const float penumbra = k_sun_tangent * above * k_map_depth / (2 * frame.shadow_step);
    const float widest = clamp(penumbra, k_narrowest_shadow, k_widest_shadow) * frame.shadow_step;
    float lit = 0;
    vec2 direction = p.direction;
    for (int i = 0; i < rounds(k_shadow_taps, mapped && above >= 0); ++i)
    {
        const vec2 offset = widest * sqrt((float(i) + 0.5) / k_shadow_taps) * direction;
        direction = next_direction(direction);
        lit += textureLod(shadow_map, vec3(p.at + offset, p.depth + dot(p.slope, offset)), 0);
    }
    return SunVisibility(lit / k_shadow_taps, widest * 2 * frame.focus_radius);
}

// Smooth where a penumbra is wider than a few pixels, so that the pattern of its samples does not show. A narrower one
// keeps its edge. Not in divergent control flow.
float sun_visibility(vec3 world, vec3 normal_to_sun)
{
    const SunVisibility sun = sample_sun(world, normal_to_sun);
    const float pixel = max(length(dFdx(world)), length(dFdy(world)));
    const float smoothing = smoothstep(1, 3, quad_mean(sun.width) / max(pixel, 1e-6));
    return mix(sun.fraction, quad_mean(sun.fraction), smoothing);
}

#endif
