// Whether a triangle intersects a half space, or a capsule; a sphere is a capsule without an axis. Everything is in the
// space of the solid, in float. Each result has a bound of its error, and is k_uncertain within it.
#ifndef VOILE_SOLID_TRIANGLE_GLSL
#define VOILE_SOLID_TRIANGLE_GLSL

// Of a sum of a few products of coordinates, relative to the largest of them: 16 roundings of 2^-23.
const float k_solid_error = 16.0 / 8388608;

// A segment between two points.
struct Gap
{
    vec3 from; // on the axis of the capsule
    vec3 to;   // in the triangle
};

Gap shorter(Gap a, Gap b)
{
    return dot(b.to - b.from, b.to - b.from) < dot(a.to - a.from, a.to - a.from) ? b : a;
}

// Between the segment from -axis to axis and the segment from a to b. Ericson 2004, Real-Time Collision Detection,
// 5.1.9.
Gap gap_between(vec3 axis, vec3 a, vec3 b)
{
    const vec3 d1 = 2 * axis;
    const vec3 d2 = b - a;
    const vec3 r = -axis - a;
    const float l1 = max(dot(d1, d1), 1e-30);
    const float l2 = max(dot(d2, d2), 1e-30);
    const float f = dot(d2, r);
    const float c = dot(d1, r);
    const float d12 = dot(d1, d2);
    const float denominator = l1 * l2 - d12 * d12;
    float s = denominator > 0 ? clamp((d12 * f - c * l2) / denominator, 0, 1) : 0;
    const float t = clamp((d12 * s + f) / l2, 0, 1);
    s = clamp((d12 * t - c) / l1, 0, 1);
    return Gap(-axis + s * d1, a + t * d2);
}

// From a point to the point of the triangle below it, or to a corner if that is outside of the triangle.
Gap gap_to_face(vec3 p, vec3 t[3])
{
    const vec3 ab = t[1] - t[0];
    const vec3 ac = t[2] - t[0];
    const vec3 normal = cross(ab, ac);
    const float area = dot(normal, normal);
    const float v = dot(cross(p - t[0], ac), normal) / area;
    const float w = dot(cross(ab, p - t[0]), normal) / area;
    const bool inside = v >= 0 && w >= 0 && v + w <= 1; // false without an area
    return Gap(p, inside ? t[0] + v * ab + w * ac : t[0]);
}

// The shortest gap, as far as floats find it.
Gap gap_between(vec3 axis, vec3 t[3])
{
    Gap best = gap_to_face(axis, t);
    for (uint i = 0; i < 3; ++i)
        best = shorter(best, gap_between(axis, t[i], t[(i + 1) % 3]));
    if (axis == vec3(0))
        return best;
    best = shorter(best, gap_to_face(-axis, t));
    const vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    const float first = dot(normal, -axis - t[0]);
    const float last = dot(normal, axis - t[0]);
    if (first * last < 0) // the axis crosses the plane
        best = shorter(best, gap_to_face(axis * (2 * first / (first - last) - 1), t));
    return best;
}

// The length of any gap is an upper bound of the distance. The distance between two parallel planes that separate both
// sets is a lower bound, and equal if the gap is the shortest one. So a gap that is not the shortest one makes the
// result uncertain, never wrong.
int intersect_capsule(vec3 axis, float radius, vec3 t[3], float error)
{
    const Gap gap = gap_between(axis, t);
    const vec3 span = gap.to - gap.from;
    const float distance = length(span);
    if (!(distance > radius + error))
        return distance <= radius - error ? k_intersects : k_uncertain;
    const vec3 direction = span / distance;
    const float triangle = min(min(dot(direction, t[0]), dot(direction, t[1])), dot(direction, t[2]));
    return triangle - abs(dot(direction, axis)) > radius + error ? k_apart : k_uncertain;
}

// normal . x <= offset.
int intersect_half_space(vec3 normal, float offset, vec3 t[3], float error)
{
    const float height = min(min(dot(normal, t[0]), dot(normal, t[1])), dot(normal, t[2])) - offset;
    return height > error ? k_apart : (height <= -error ? k_intersects : k_uncertain);
}

#endif
