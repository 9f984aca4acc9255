// The heat map of strain on fabric.
#ifndef VOILE_STRAIN_GLSL
#define VOILE_STRAIN_GLSL

// The largest stretch of a triangle in any direction, l / L - 1, from the derivatives of its points and of its texture
// coordinates, which are meters of fabric, along x and y of the picture. It is the larger singular value of the
// deformation gradient, less 1. 0 if the texture coordinates have no area.
float largest_stretch(vec3 world_x, vec3 world_y, vec2 fabric_x, vec2 fabric_y)
{
    const float area = fabric_x.x * fabric_y.y - fabric_x.y * fabric_y.x;
    if (area == 0)
        return 0;
    const vec3 warp = (fabric_y.y * world_x - fabric_x.y * world_y) / area;
    const vec3 weft = (fabric_x.x * world_y - fabric_y.x * world_x) / area;
    const float a = dot(warp, warp);
    const float b = dot(warp, weft);
    const float c = dot(weft, weft);
    return sqrt(0.5 * (a + c) + length(vec2(0.5 * (a - c), b))) - 1;
}

// Blue at 0, green, yellow, red at 1.
vec3 heat_color(float value)
{
    const float x = clamp(value, 0, 1);
    const vec3 low = mix(vec3(0.02, 0.05, 0.45), vec3(0.03, 0.5, 0.1), clamp(2.5 * x, 0, 1));
    const vec3 high = mix(vec3(0.8, 0.65, 0.03), vec3(0.75, 0.01, 0.02), clamp(2.5 * x - 1.5, 0, 1));
    return mix(low, high, smoothstep(0.35, 0.6, x));
}

#endif
