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

// The difference of the two sets is a polygon with the directions of the four edges. So one of the four lines separates
// them if they are apart, unless all points lie on one line: then their boxes are apart. `signs`: of the triangle; of
// the edge's two ends seen from each of its sides; of its corners seen from the edge.
bool are_separated(int signs[10])
{
    for (uint side = 0; side < 3; ++side)
    {
        const int p = signs[1 + 2 * side];
        if (abs(p) == 1 && p == signs[2 + 2 * side] && signs[0] != p && signs[0] != k_uncertain)
            return true;
    }
    return abs(signs[7]) == 1 && signs[7] == signs[8] && signs[7] == signs[9];
}

// Of points of one plane, whose boxes overlap. A projection along an axis keeps all of the plane, or a line of it. The
// sets intersect if none of the three separates them.
int intersect_in_plane(EdgeTriangle pair)
{
    const uvec3 corners[10] =
        uvec3[](uvec3(0, 1, 2), uvec3(0, 1, 3), uvec3(0, 1, 4), uvec3(1, 2, 3), uvec3(1, 2, 4), uvec3(2, 0, 3),
                uvec3(2, 0, 4), uvec3(3, 4, 0), uvec3(3, 4, 1), uvec3(3, 4, 2));
    bool certain = true;
    for (uint axis = 0; axis < 3; ++axis)
    {
        int signs[10];
        bool known = true;
        for (uint i = 0; i < 10; ++i)
        {
            signs[i] = area_sign(pair, axis, corners[i]);
            known = known && signs[i] != k_uncertain;
        }
        if (are_separated(signs))
            return k_apart;
        certain = certain && known;
    }
    return certain ? k_intersects : k_uncertain;
}

// k_apart, k_intersects, or k_uncertain where a sign that decides is.
//
// Both ends on one side of the triangle's plane: apart. Both ends in it: then they intersect in the plane; a volume of
// the edge and a side shows that the triangle has no area and is skew to the edge. Otherwise the line of the edge
// crosses the plane in one point, which is in the triangle if no two sides have opposite orientations around that line.
int intersect(EdgeTriangle pair)
{
    const uvec4 volumes[5] = uvec4[](uvec4(0, 1, 2, 3), uvec4(0, 1, 2, 4), uvec4(3, 4, 0, 1), uvec4(3, 4, 1, 2),
                                     uvec4(3, 4, 2, 0));
    int signs[5];
    bool certain = true;
    for (uint i = 0; i < 5; ++i)
    {
        const uvec4 v = volumes[i];
        signs[i] = orientation(pair.points[v.x], pair.points[v.y], pair.points[v.z], pair.points[v.w]);
        certain = certain && signs[i] != k_uncertain;
        if (i == 1 && signs[0] * signs[1] == 1)
            return k_apart;
    }
    if (signs[2] * signs[3] == -1 || signs[3] * signs[4] == -1 || signs[4] * signs[2] == -1)
        return k_apart;
    if (signs[0] != 0 || signs[1] != 0)
        return certain ? k_intersects : k_uncertain;
    for (uint i = 2; i < 5; ++i)
        if (abs(signs[i]) == 1)
            return k_apart;
    return certain ? intersect_in_plane(pair) : k_uncertain;
}

#endif
