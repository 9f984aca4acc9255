// Triangles, and tests of them against a segment and against a point.
#ifndef VOILE_TRIANGLE_GLSL
#define VOILE_TRIANGLE_GLSL

struct Triangle
{
    vec3 a;
    vec3 b;
    vec3 c;
};

// The parameter in [0, 1] at which the segment from `origin` to `origin + span` hits triangle (a, b, c), from either
// side; 2 for a miss. Möller and Trumbore 1997. Hits on an edge, or within rounding of it, count for both triangles, so
// that no segment passes between them.
float segment_triangle(vec3 origin, vec3 span, vec3 a, vec3 b, vec3 c)
{
    const vec3 e1 = b - a;
    const vec3 e2 = c - a;
    const vec3 p = cross(span, e2);
    const float determinant = dot(e1, p);
    if (determinant == 0)
        return 2;
    const float inverse = 1 / determinant;
    const vec3 s = origin - a;
    const float u = dot(s, p) * inverse;
    const vec3 q = cross(s, e1);
    const float v = dot(span, q) * inverse;
    const float t = dot(e2, q) * inverse;
    const float rounding = 1e-6;
    const bool inside = u >= -rounding && v >= -rounding && u + v <= 1 + rounding && t >= 0 && t <= 1;
    return inside ? t : 2;
}

// The point of triangle (a, b, c) nearest to p. Ericson 2004, Real-Time Collision Detection, 5.1.5: the Voronoi region
// of p decides between the three vertices, the three edges and the face. All are computed and the last valid one
// is taken, because neighboring threads would diverge at branches.
vec3 nearest_on_triangle(vec3 p, vec3 a, vec3 b, vec3 c)
{
    const vec3 ab = b - a;
    const vec3 ac = c - a;
    const vec3 ap = p - a;
    const vec3 bp = p - b;
    const vec3 cp = p - c;
    const float d1 = dot(ab, ap);
    const float d2 = dot(ac, ap);
    const float d3 = dot(ab, bp);
    const float d4 = dot(ac, bp);
    const float d5 = dot(ab, cp);
    const float d6 = dot(ac, cp);
    // From the normal, not from areas: in a long thin triangle areas are differences of large numbers, and the offset
    // from the point would lean along the triangle.
    const vec3 normal = cross(ab, ac);
    vec3 point = p - dot(ap, normal) / dot(normal, normal) * normal;
    const float on_bc = d4 - d3;
    const float on_cb = d5 - d6;
    if (d3 * d6 - d5 * d4 <= 0 && on_bc >= 0 && on_cb >= 0)
        point = b + on_bc / (on_bc + on_cb) * (c - b);
    if (d5 * d2 - d1 * d6 <= 0 && d2 >= 0 && d6 <= 0)
        point = a + d2 / (d2 - d6) * ac;
    point = d6 >= 0 && d5 <= d6 ? c : point;
    if (d1 * d4 - d3 * d2 <= 0 && d1 >= 0 && d3 <= 0)
        point = a + d1 / (d1 - d3) * ab;
    point = d3 >= 0 && d4 <= d3 ? b : point;
    return d1 <= 0 && d2 <= 0 ? a : point;
}

#endif
