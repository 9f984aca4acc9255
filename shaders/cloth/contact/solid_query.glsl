// Queries of a mesh as a solid: inside or outside, depth, the exits of a line, the crossing of a segment.
//
// They are in the collider's space, at the step's start, or at its end if `solid_at_end`. The including kernel declares
// `bvh_nodes[]`, `bvh_triangles[]`, `padded_boxes[]`, `padded_leaves[]`, `deforming_positions[]` and includes
// collider_pose.glsl before.
#ifndef VOILE_SOLID_QUERY_GLSL
#define VOILE_SOLID_QUERY_GLSL

#include "contact/triangle.glsl"
#include "shared/constants.glsl"

struct Corners
{
    vec3 a;
    vec3 b;
    vec3 c;
};

bool solid_at_end = false;

const int k_solid_line = 0; // along an axis, in both directions
const int k_solid_segment = 1;
const int k_solid_nearest = 2; // the nearest surface

struct SolidQuery
{
    int kind;
    bool deforms;
    uint first_corner; // of a mesh that deforms: its first vertex
    vec3 origin;

    int axis;      // of the line
    int winding;   // winding number of the mesh around the origin
    float ends[2]; // m, distances to the last crossings of the line, ahead of and behind the origin

    vec3 span;      // m, of the segment from the origin
    bool outwards;  // only crossings from inside count
    float crossing; // the first, as a fraction of the span; 2: none
    vec3 normal;    // there, unit, outwards

    float distance; // m, to the nearest surface so far
};
SolidQuery solid;

Corners corners_of(uint index)
{
    if (!solid.deforms)
    {
        const BvhTriangle stored = bvh_triangles[index];
        return Corners(stored.a, stored.b, stored.c);
    }
    const uvec3 corners = solid.first_corner + padded_leaves[index].corners;
    return Corners(deforming_positions[corners.x].xyz, deforming_positions[corners.y].xyz,
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
// the triangles on one side of the origin is the winding number of a closed mesh, also if the line meets edges and
// vertices.
void visit_line(Corners t, vec3 normal)
{
    const int x = (solid.axis + 1) % 3;
    const int y = (solid.axis + 2) % 3;
    const vec3 a = t.a - solid.origin;
    const vec3 b = t.b - solid.origin;
    const vec3 c = t.c - solid.origin;
    const vec2 pa = vec2(a[x], a[y]);
    const vec2 pb = vec2(b[x], b[y]);
    const vec2 pc = vec2(c[x], c[y]);
    const int winding = edge_winding(pa, pb) + edge_winding(pb, pc) + edge_winding(pc, pa);
    if (winding == 0)
        return;
    const vec3 heights = vec3(a[solid.axis], b[solid.axis], c[solid.axis]);
    const float lowest = min(heights.x, min(heights.y, heights.z));
    const float highest = max(heights.x, max(heights.y, heights.z));
    const float slope = normal[solid.axis];
    const float height = slope == 0 ? lowest : clamp(dot(a, normal) / slope, lowest, highest);
    solid.winding += height > 0 ? winding : 0;
    solid.ends[0] = max(solid.ends[0], height);
    solid.ends[1] = max(solid.ends[1], -height);
}

void visit_segment(Corners t, vec3 normal)
{
    const float along = segment_triangle(solid.origin, solid.span, t.a, t.b, t.c);
    if (along >= solid.crossing || (solid.outwards && dot(solid.span, normal) <= 0))
        return;
    solid.crossing = along;
    solid.normal = normalize(normal);
}

void take_leaf(uint first, uint count)
{
    for (uint i = first; i < first + count; ++i)
    {
        const Corners t = corners_of(i);
        const vec3 normal = cross(t.b - t.a, t.c - t.a);
        if (solid.kind == k_solid_line)
            visit_line(t, normal);
        else if (solid.kind == k_solid_segment)
            visit_segment(t, normal);
        else
            solid.distance = min(solid.distance, distance(solid.origin, nearest_on_triangle(solid.origin, t.a, t.b, t.c)));
    }
}

bool boxes_overlap(vec3 a_min, vec3 a_max, vec3 b_min, vec3 b_max)
{
    return all(lessThanEqual(a_min, b_max)) && all(lessThanEqual(b_min, a_max));
}

bool solid_enters(vec3 box_min, vec3 box_max, vec3 node_min, vec3 node_max)
{
    if (solid.kind == k_solid_nearest)
        return distance(solid.origin, clamp(solid.origin, node_min, node_max)) <= solid.distance;
    return boxes_overlap(box_min, box_max, node_min, node_max);
}

#define VOILE_ENTERS solid_enters
#include "colliders/bvh.glsl"
#include "colliders/padded.glsl"

void begin_solid_query(uint c, ColliderRecord collider, int kind, vec3 origin)
{
    solid.kind = kind;
    solid.origin = origin;
    solid.deforms = is_deforming(collider.flags);
    if (solid.deforms)
        solid.first_corner = solid_at_end ? collider_motions[c].first_to : collider_motions[c].first_from;
}

void visit(ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    if (solid.deforms)
        visit_padded(collider.first_node, collider.first_triangle, collider.triangles, box_min, box_max);
    else
        visit_box(collider.first_node, collider.first_triangle, box_min, box_max);
}

// The winding number of the mesh around a point. `solid.ends` are the last crossings of the line along the axis. Boxes
// of the hierarchy are exact, so a box without width finds all triangles that the line meets.
int line_winding(uint c, ColliderRecord collider, vec3 origin, int axis)
{
    begin_solid_query(c, collider, k_solid_line, origin);
    solid.axis = axis;
    solid.winding = 0;
    solid.ends[0] = solid.ends[1] = 0;
    vec3 box_min = origin;
    vec3 box_max = origin;
    box_min[axis] = -3e38;
    box_max[axis] = 3e38;
    visit(collider, box_min, box_max);
    return solid.winding;
}

// Whether the segment crosses the mesh; `outwards`: from inside. The first crossing is in `solid`.
bool crosses(uint c, ColliderRecord collider, vec3 from, vec3 to, bool outwards)
{
    begin_solid_query(c, collider, k_solid_segment, from);
    solid.span = to - from;
    solid.outwards = outwards;
    solid.crossing = 2;
    visit(collider, min(from, to), max(from, to));
    return solid.crossing <= 1;
}

bool in_box(ColliderRecord collider, vec3 local)
{
    if (!is_deforming(collider.flags))
        return boxes_overlap(local, local, collider.box_min, collider.box_max);
    const PaddedBox root = padded_boxes[collider.first_node];
    return boxes_overlap(local, local, root.min, root.max);
}

// m: distance to the nearest surface, at most `limit`.
float nearest_distance(uint c, ColliderRecord collider, vec3 origin, float limit)
{
    begin_solid_query(c, collider, k_solid_nearest, origin);
    solid.distance = limit;
    visit(collider, origin - limit, origin + limit);
    return solid.distance;
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
float generalized_winding(uint c, ColliderRecord collider, vec3 origin)
{
    begin_solid_query(c, collider, k_solid_line, origin);
    float sum = 0;
    for (uint i = 0; i < collider.triangles; ++i)
    {
        const Corners t = corners_of(collider.first_triangle + i);
        sum += half_solid_angle(t.a - origin, t.b - origin, t.c - origin);
    }
    return sum / k_two_pi;
}

#endif
