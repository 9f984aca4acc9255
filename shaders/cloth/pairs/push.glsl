// Along which a pair pushes, and how much of it is left to others. Guards hold all pairs, along the direction between their
// nearest points. Where vertices lie above vertices, up to 40 pairs have the same ones, and a layer that was pushed along that
// direction slid from vertex to vertex, as if each were a hill.
#ifndef VOILE_PUSH_GLSL
#define VOILE_PUSH_GLSL

// Nearest points with a smaller weight of a vertex are at an end of an edge.
const float k_end = 1e-4;
// The sine of the angle between edges below which a pair of them fades.
const float k_parallel = 0.1;
// The cosine of the largest angle between a triangle's normal and a direction that the triangle replaces by it.
const float k_steep = 0.87;

// `n`: unit, between the nearest points. Where those are on the rim of the triangle, a neighbor of it may be nearer, and has the
// right direction. In cloth that is almost flat this triangle has it, too.
vec3 push_direction(bool edges, vec3 x[4], vec3 n)
{
    if (edges)
        return n;
    const vec3 across = cross(x[2] - x[1], x[3] - x[1]);
    const vec3 face = across / max(length(across), 1e-30);
    const float along = dot(face, n);
    return abs(along) < k_steep ? n : along < 0 ? -face : face;
}

// 0..1: what a pair does itself. Edges whose nearest points are at an end of one leave it to a vertex and a triangle that have the
// same nearest points; parallel ones, which have many, to those of their ends.
float uncovered_part(bool edges, vec3 x[4], vec4 weights)
{
    if (!edges)
        return 1;
    if (any(lessThan(abs(weights), vec4(k_end))))
        return 0;
    const vec3 u = x[1] - x[0];
    const vec3 v = x[3] - x[2];
    const vec3 across = cross(u, v);
    return min(dot(across, across) / max(k_parallel * k_parallel * dot(u, u) * dot(v, v), 1e-30), 1);
}

#endif
