// A plane between two edges, or between a vertex and a triangle: a pair of sides with four vertices in all.
#ifndef VOILE_SEPARATION_GLSL
#define VOILE_SEPARATION_GLSL

#include "shared/segments.glsl"

// The nearest points of both sides.
struct Nearest
{
    vec4 weights; // of the vertices: they sum to 1 on the first side and to -1 on the second
    vec3 apart;   // m, from the second side's point to the first side's
};

// The barycentric coordinates of the point of triangle (a, b, c) nearest to the origin.
vec3 nearest_weights(vec3 a, vec3 b, vec3 c)
{
    const vec3 ab = b - a;
    const vec3 ac = c - a;
    const float d1 = -dot(ab, a);
    const float d2 = -dot(ac, a);
    const float d3 = -dot(ab, b);
    const float d4 = -dot(ac, b);
    const float d5 = -dot(ab, c);
    const float d6 = -dot(ac, c);
    if (d1 <= 0 && d2 <= 0)
        return vec3(1, 0, 0);
    if (d3 >= 0 && d4 <= d3)
        return vec3(0, 1, 0);
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return vec3(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
    if (d6 >= 0 && d5 <= d6)
        return vec3(0, 0, 1);
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return vec3(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
    const float va = d3 * d6 - d5 * d4;
    const float on_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    if (va <= 0 && d4 >= d3 && d5 >= d6)
        return vec3(0, 1 - on_bc, on_bc);
    const float scale = 1 / (va + vb + vc);
    return vec3(1 - (vb + vc) * scale, vb * scale, vc * scale);
}

// `x`: m, the vertices of a pair, relative to any point near them.
Nearest nearest_points(bool edges, vec3 x[4])
{
    Nearest nearest;
    if (edges)
    {
        const vec2 at = nearest_on_segments(x[0], x[1], x[2], x[3]);
        nearest.weights = vec4(1 - at.x, at.x, at.y - 1, -at.y);
    }
    else
        nearest.weights = vec4(1, -nearest_weights(x[1] - x[0], x[2] - x[0], x[3] - x[0]));
    nearest.apart = nearest.weights.y * (x[1] - x[0]) + nearest.weights.z * (x[2] - x[0]) +
                    nearest.weights.w * (x[3] - x[0]);
    return nearest;
}

// Towards the first side, of any length. Points a few micrometers apart are too near for a direction in float: their
// rounding would tilt it by a thousandth. Within both sides the sides themselves have it.
vec3 separating_direction(bool edges, vec3 x[4], Nearest nearest)
{
    const vec4 inner = abs(nearest.weights);
    const bool within = edges ? all(greaterThan(inner, vec4(0))) : all(greaterThan(inner.yzw, vec3(0)));
    const vec3 u = edges ? x[1] - x[0] : x[2] - x[1];
    const vec3 v = edges ? x[3] - x[2] : x[3] - x[1];
    const vec3 across = cross(u, v);
    if (!within || dot(across, across) <= 1e-4 * dot(u, u) * dot(v, v))
        return nearest.apart;
    return dot(across, nearest.apart) < 0 ? -across : across;
}

// A plane between both sides. Each side of a pair is on its side of two parallel planes with the normal `n`, whatever
// rounding did to the nearest points. If they are nearer than the rounding of the normal, whose error is as long as they
// are long, the planes do not separate them. Then no vertex may approach along the normal.
struct Separation
{
    vec3 n;    // unit, towards the first side
    float gap; // m, between the planes; below 0: they do not separate
    vec4 from_plane; // m, of each vertex, from the plane of its side, away from the other side
};

Separation separate(bool edges, vec3 x[4], vec3 n)
{
    Separation result;
    result.n = n;
    const vec4 heights = vec4(0, dot(n, x[1] - x[0]), dot(n, x[2] - x[0]), dot(n, x[3] - x[0]));
    const float low = edges ? min(heights.x, heights.y) : heights.x;
    const float high = edges ? max(heights.z, heights.w) : max(heights.y, max(heights.z, heights.w));
    result.gap = low - high;
    result.from_plane = vec4(heights.x - low, edges ? heights.y - low : high - heights.y, high - heights.zw);
    if (result.gap <= 0)
        result.from_plane = vec4(0);
    return result;
}

#endif
