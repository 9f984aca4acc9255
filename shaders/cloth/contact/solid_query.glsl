// Queries of a mesh as a solid, in the collider's space: inside or outside, depth, the exits of a line, the crossing of
// a segment.
//
// The including kernel declares `bvh_nodes[]`, `bvh_triangles[]`, `padded_boxes[]`, `padded_leaves[]`,
// `deforming_positions[]` and includes collider_pose.glsl before.
#ifndef VOILE_SOLID_QUERY_GLSL
#define VOILE_SOLID_QUERY_GLSL

#include "contact/triangle.glsl"
#include "shared/box.glsl"
#include "shared/constants.glsl"

// A collider at the step's start or end.
struct Solid
{
    uint index;
    ColliderRecord collider;
    bool at_end;
};

const int k_solid_line = 0; // along an axis, in both directions
const int k_solid_segment = 1;
const int k_solid_nearest = 2; // the nearest surface

// A query and its result so far.
struct SolidQuery
{
    int kind;
    bool deforms;
    uint first_corner; // of a mesh that deforms: its first vertex
    vec3 origin;
    Box box; // that the query enters

    int axis;     // of the line
    int winding;  // winding number of the mesh around the origin
    float ahead;  // m, distance to the last crossing of the line along the axis
    float behind; // m, and against it

    vec3 span;      // m, of the segment from the origin
    bool outwards;  // only crossings from inside count
    float crossing; // the first, as a fraction of the span; 2: none

    float distance; // m, to the nearest surface so far
};

Triangle solid_triangle(SolidQuery query, uint index)
{
    if (!query.deforms)
    {
        const BvhTriangle stored = bvh_triangles[index];
        return Triangle(stored.a, stored.b, stored.c);
    }
    const uvec3 corners = query.first_corner + padded_leaves[index].corners;
    return Triangle(deforming_positions[corners.x].xyz, deforming_positions[corners.y].xyz,
                    deforming_positions[corners.z].xyz);
}

// The winding of the edge from a to b around the half line from 0 along +x: 1 if it crosses upwards, -1 if downwards.
// Equal to the bit to minus that of the edge from b to a: both triangles of an edge agree, whatever rounding does.
int edge_winding(vec2 a, vec2 b)
{
    precise const float left = a.x * b.y;
    precise const float right = b.x * a.y;
    if (a.y <= 0 && b.y > 0 && left > right)
        return 1;
    return a.y > 0 && b.y <= 0 && left < right ? -1 : 0;
}

// The winding of the triangle as seen along the line (Sunday 2001, "Inclusion of a point in a polygon"). The sum over
// the triangles on one side of the origin is the winding number of a closed mesh, also if the line crosses edges
// and vertices.
void visit_line(inout SolidQuery query, Triangle t, vec3 normal)
{
    const int x = (query.axis + 1) % 3;
    const int y = (query.axis + 2) % 3;
    const vec3 a = t.a - query.origin;
    const vec3 b = t.b - query.origin;
    const vec3 c = t.c - query.origin;
    const vec2 pa = vec2(a[x], a[y]);
    const vec2 pb = vec2(b[x], b[y]);
    const vec2 pc = vec2(c[x], c[y]);
    const int winding = edge_winding(pa, pb) + edge_winding(pb, pc) + edge_winding(pc, pa);
    if (winding == 0)
        return;
    const vec3 heights = vec3(a[query.axis], b[query.axis], c[query.axis]);
    const float lowest = min(heights.x, min(heights.y, heights.z));
    const float highest = max(heights.x, max(heights.y, heights.z));
    const float slope = normal[query.axis];
    const float height = slope == 0 ? lowest : clamp(dot(a, normal) / slope, lowest, highest);
    query.winding += height > 0 ? winding : 0;
    query.ahead = max(query.ahead, height);
    query.behind = max(query.behind, -height);
}

void visit_segment(inout SolidQuery query, Triangle t, vec3 normal)
{
    const float along = segment_triangle(query.origin, query.span, t.a, t.b, t.c);
    if (along < query.crossing && !(query.outwards && dot(query.span, normal) <= 0))
        query.crossing = along;
}

bool enters_node(SolidQuery query, Box node)
{
    if (query.kind == k_solid_nearest)
        return distance(query.origin, clamp(query.origin, node.min, node.max)) <= query.distance;
    return overlap(query.box, node);
}

void visit_leaf(inout SolidQuery query, uint first, uint count)
{
    for (uint i = first; i < first + count; ++i)
    {
        const Triangle t = solid_triangle(query, i);
        const vec3 normal = cross(t.b - t.a, t.c - t.a);
        if (query.kind == k_solid_line)
            visit_line(query, t, normal);
        else if (query.kind == k_solid_segment)
            visit_segment(query, t, normal);
        else
            query.distance =
                min(query.distance, distance(query.origin, nearest_on_triangle(query.origin, t.a, t.b, t.c)));
    }
}

#define VOILE_QUERY SolidQuery
#include "colliders/mesh_traversal.glsl"
#undef VOILE_QUERY

SolidQuery solid_query(Solid solid, int kind, vec3 origin)
{
    SolidQuery query;
    query.kind = kind;
    query.origin = origin;
    query.deforms = is_deforming(solid.collider.flags);
    if (query.deforms)
        query.first_corner =
            solid.at_end ? collider_motions[solid.index].first_to : collider_motions[solid.index].first_from;
    return query;
}

// The last exits of a line along an axis from a mesh.
struct LineExits
{
    int winding;  // winding number of the mesh around the line's origin
    float ahead;  // m, along the axis
    float behind; // m, against it
};

// The query of a line along an axis. Boxes of the hierarchy are exact, so a box without width finds all triangles that
// the line crosses.
SolidQuery line_query(Solid solid, vec3 origin, int axis)
{
    SolidQuery query = solid_query(solid, k_solid_line, origin);
    query.axis = axis;
    query.winding = 0;
    query.ahead = query.behind = 0;
    query.box = Box(origin, origin);
    query.box.min[axis] = -3e38;
    query.box.max[axis] = 3e38;
    return query;
}

LineExits line_exits(Solid solid, vec3 origin, int axis)
{
    SolidQuery query = line_query(solid, origin, axis);
    traverse(query, solid.collider);
    return LineExits(query.winding, query.ahead, query.behind);
}

// The query of a segment. `outwards`: only crossings from inside count.
SolidQuery segment_query(Solid solid, vec3 from, vec3 to, bool outwards)
{
    SolidQuery query = solid_query(solid, k_solid_segment, from);
    query.span = to - from;
    query.outwards = outwards;
    query.crossing = 2;
    query.box = box_around(from, to);
    return query;
}

bool in_box(ColliderRecord collider, vec3 local)
{
    Box box = Box(collider.box_min, collider.box_max);
    if (is_deforming(collider.flags))
        box = padded_box(collider.first_node);
    return overlap(Box(local, local), box);
}

// m: distance to the nearest surface, at most `limit`.
float nearest_distance(Solid solid, vec3 origin, float limit)
{
    SolidQuery query = solid_query(solid, k_solid_nearest, origin);
    query.distance = limit;
    traverse(query, solid.collider);
    return query.distance;
}

// Half of the signed solid angle of a triangle seen from the origin (Van Oosterom and Strackee 1983).
float half_solid_angle(vec3 a, vec3 b, vec3 c)
{
    const float la = length(a);
    const float lb = length(b);
    const float lc = length(c);
    return atan(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

// The generalized winding number: the fraction of all directions that the mesh fills, seen from a point (Jacobson et
// al. 2013, "Robust inside-outside segmentation using generalized winding numbers"). Visits every triangle.
float generalized_winding(Solid solid, vec3 origin)
{
    const SolidQuery query = solid_query(solid, k_solid_line, origin);
    float sum = 0;
    for (uint i = 0; i < solid.collider.triangles; ++i)
    {
        const Triangle t = solid_triangle(query, solid.collider.first_triangle + i);
        sum += half_solid_angle(t.a - origin, t.b - origin, t.c - origin);
    }
    return sum / k_two_pi;
}

#endif
