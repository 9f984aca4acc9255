// Whether an edge and a triangle intersect, as closed sets: touching counts, and so does overlap within a plane.
#ifndef VOILE_EDGE_TRIANGLE_GLSL
#define VOILE_EDGE_TRIANGLE_GLSL

#include "intersections/orientation.glsl"
#include "shared/box.glsl"

// Results, beside k_uncertain.
const int k_apart = 0;
const int k_intersects = 1;

// The corners of the triangle, then the ends of the edge.
struct EdgeTriangle
{
    vec3 points[5];
};

Box triangle_box(vec3 a, vec3 b, vec3 c) { return Box(min(min(a, b), c), max(max(a, b), c)); }

// Points in the plane of two axes, in the order of EdgeTriangle.
int area_sign(EdgeTriangle pair, uint axis, uvec3 corners)
{
    const uvec2 kept = uvec2(axis == 0 ? 1 : 0, axis == 2 ? 1 : 2);
    const vec3 u = vec3(pair.points[corners.x][kept.x], pair.points[corners.x][kept.y], 0);
    const vec3 v = vec3(pair.points[corners.y][kept.x], pair.points[corners.y][kept.y], 0);
    const vec3 w = vec3(pair.points[corners.z][kept.x], pair.points[corners.z][kept.y], 0);
    return orientation(u, v, vec3(w.xy, 1), w);
}

// Signs, two bits each. Drivers unroll a loop whose counter indexes an array, and each copy contains the exact integers
// (bench/NOTES.md).
int sign_at(int signs, int i) { return bitfieldExtract(signs, 2 * i, 2); }
int with_sign(int signs, int i, int added) { return bitfieldInsert(signs, added, 2 * i, 2); }

// The difference of the two sets is a polygon with the directions of the four edges. So one of the four lines separates
// them if they are apart, unless all points lie on one line: then their boxes are apart. `signs`: of the triangle; of
// the edge's two ends seen from each of its sides; of its corners seen from the edge.
bool are_separated(int signs)
{
    const int whole = sign_at(signs, 0);
    for (int side = 0; side < 3; ++side)
    {
        const int p = sign_at(signs, 1 + 2 * side);
        if (abs(p) == 1 && p == sign_at(signs, 2 + 2 * side) && whole != p && whole != k_uncertain)
            return true;
    }
    const int p = sign_at(signs, 7);
    return abs(p) == 1 && p == sign_at(signs, 8) && p == sign_at(signs, 9);
}

// The corners of the i-th area of are_separated.
uvec3 area_corners(int i)
{
    if (i == 0)
        return uvec3(0, 1, 2);
    if (i >= 7)
        return uvec3(3, 4, i - 7);
    const uint side = uint(i - 1) / 2;
    return uvec3(side, (side + 1) % 3, 4 - i % 2);
}

// Of points of one plane, whose boxes overlap. A projection along an axis keeps all of the plane, or a line of it. The
// sets intersect if none of the three separates them.
int intersect_in_plane(EdgeTriangle pair)
{
    bool certain = true;
    for (uint axis = 0; axis < 3; ++axis)
    {
        int signs = 0;
        bool known = true;
        for (int i = 0; i < 10; ++i)
        {
            const int found = area_sign(pair, axis, area_corners(i));
            signs = with_sign(signs, i, found);
            known = known && found != k_uncertain;
        }
        if (are_separated(signs))
            return k_apart;
        certain = certain && known;
    }
    return certain ? k_intersects : k_uncertain;
}

// Of each end of the edge seen from the triangle, then of each side seen from the edge.
uvec4 volume_corners(int i)
{
    const uint side = uint(i - 2);
    return i < 2 ? uvec4(0, 1, 2, 3 + i) : uvec4(3, 4, side, (side + 1) % 3);
}

// k_apart, k_intersects, or k_uncertain where a sign that decides is.
//
// Both ends on one side of the triangle's plane: apart. Both ends in it: then they intersect in the plane; a volume of
// the edge and a side shows that the triangle has no area and is skew to the edge. Otherwise the line of the edge
// crosses the plane in one point, which is in the triangle if no two sides have opposite orientations around that line.
int intersect(EdgeTriangle pair)
{
    int signs = 0;
    bool certain = true;
    for (int i = 0; i < 5; ++i)
    {
        const uvec4 v = volume_corners(i);
        const int found = orientation(pair.points[v.x], pair.points[v.y], pair.points[v.z], pair.points[v.w]);
        signs = with_sign(signs, i, found);
        certain = certain && found != k_uncertain;
        if (i == 1 && sign_at(signs, 0) * found == 1)
            return k_apart;
    }
    const ivec3 sides = ivec3(sign_at(signs, 2), sign_at(signs, 3), sign_at(signs, 4));
    if (any(equal(sides * sides.yzx, ivec3(-1))))
        return k_apart;
    if (sign_at(signs, 0) != 0 || sign_at(signs, 1) != 0)
        return certain ? k_intersects : k_uncertain;
    if (any(equal(abs(sides), ivec3(1))))
        return k_apart;
    return certain ? intersect_in_plane(pair) : k_uncertain;
}

#endif
