// Two segments.
#ifndef VOILE_SEGMENTS_GLSL
#define VOILE_SEGMENTS_GLSL

// Of segments (a, b) and (c, d): the parameter of each. Ericson 2004, Real-Time Collision Detection, 5.1.9.
vec2 nearest_on_segments(vec3 a, vec3 b, vec3 c, vec3 d)
{
    const vec3 d1 = b - a;
    const vec3 d2 = d - c;
    const vec3 r = a - c;
    const float aa = dot(d1, d1);
    const float ee = dot(d2, d2);
    const float f = dot(d2, r);
    const float g = dot(d1, r);
    const float m = dot(d1, d2);
    const float determinant = aa * ee - m * m;
    float s = 0.5; // of parallel edges
    if (determinant > 1e-6 * aa * ee)
        s = clamp((m * f - g * ee) / determinant, 0, 1);
    float t = ee > 0 ? (m * s + f) / ee : 0;
    if (t < 0 || t > 1)
    {
        t = clamp(t, 0, 1);
        s = aa > 0 ? clamp((t * m - g) / aa, 0, 1) : 0;
    }
    return vec2(s, t);
}

// m
float segment_distance(vec3 a, vec3 b, vec3 c, vec3 d)
{
    const vec2 at = nearest_on_segments(a, b, c, d);
    return distance(mix(a, b, at.x), mix(c, d, at.y));
}

// m^2, of x from the segment from 0 to `end`
float squared_distance_from_segment(vec3 x, vec3 end)
{
    const vec3 apart = x - clamp(dot(x, end) / max(dot(end, end), 1e-30), 0, 1) * end;
    return dot(apart, apart);
}

#endif
