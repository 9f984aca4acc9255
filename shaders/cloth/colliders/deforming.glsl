// Triangles of meshes that deform, within a substep.
//
// The including kernel declares `padded_leaves[]` and `deforming_positions[]`.
#ifndef VOILE_DEFORMING_GLSL
#define VOILE_DEFORMING_GLSL

#include "contact/triangle.glsl"

// A triangle at the start and at the end of a substep.
struct MovingTriangle
{
    Triangle start;
    Triangle end;
};

// The triangle in a slot. In the step, vertices move along straight lines from `first.x + corner` to `first.y +
// corner`.
// `progress`: of the step, at the start and at the end of the substep.
MovingTriangle moving_triangle(uint slot, uvec2 first, vec2 progress)
{
    const uvec3 corners = padded_leaves[slot].corners;
    vec3 start[3];
    vec3 end[3];
    for (int i = 0; i < 3; ++i)
    {
        const vec3 from = deforming_positions[first.x + corners[i]].xyz;
        const vec3 to = deforming_positions[first.y + corners[i]].xyz;
        start[i] = mix(from, to, progress.x);
        end[i] = mix(from, to, progress.y);
    }
    return MovingTriangle(Triangle(start[0], start[1], start[2]), Triangle(end[0], end[1], end[2]));
}

// A point's barycentric coordinates of b and c, and its height over the triangle, m.
vec3 triangle_coordinates(Triangle t, vec3 p)
{
    const vec3 e1 = t.b - t.a;
    const vec3 e2 = t.c - t.a;
    const vec3 n = cross(e1, e2);
    const float area = max(dot(n, n), 1e-30);
    const vec3 s = p - t.a;
    return vec3(dot(cross(s, e2), n) / area, dot(cross(e1, s), n) / area, dot(s, n) * inversesqrt(area));
}

vec3 from_coordinates(Triangle t, vec3 coordinates)
{
    const vec3 e1 = t.b - t.a;
    const vec3 e2 = t.c - t.a;
    const vec3 n = cross(e1, e2);
    return t.a + coordinates.x * e1 + coordinates.y * e2 + coordinates.z * inversesqrt(max(dot(n, n), 1e-30)) * n;
}

// The point carried along by the triangle: same barycentric coordinates, same height, same side.
vec3 carried(MovingTriangle moving, vec3 p)
{
    return from_coordinates(moving.end, triangle_coordinates(moving.start, p));
}

// m: the displacement of the triangle at a point of its end position.
vec3 triangle_displacement(MovingTriangle moving, vec3 p)
{
    const vec2 bc = triangle_coordinates(moving.end, p).xy;
    const vec3 weights = vec3(1 - bc.x - bc.y, bc);
    return mat3(moving.end.a - moving.start.a, moving.end.b - moving.start.b, moving.end.c - moving.start.c) * weights;
}

#endif
