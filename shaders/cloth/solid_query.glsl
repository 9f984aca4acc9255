// Whether a point lies inside a closed mesh, where lines through it leave the mesh, and what a segment crosses.
//
// All of this is in the collider's space, at the step's start. The including kernel declares `bvh_nodes[]`,
// `bvh_triangles[]`, `padded_boxes[]`, `padded_leaves[]`, `deforming_positions[]` and includes collider_pose.glsl before.
#ifndef VOILE_SOLID_QUERY_GLSL
#define VOILE_SOLID_QUERY_GLSL

#include "triangle.glsl"

struct Corners
{
    vec3 a;
    vec3 b;
    vec3 c;
};

struct SolidQuery
{
    bool line; // along an axis, in both directions; else a segment
    bool deforms;
    uint first_corner; // of a mesh that deforms: its first vertex
    vec3 origin;

    int axis;      // of the line
    int winding;   // how often the mesh winds around the origin
    float ends[2]; // m, the farthest places at which the line meets the mesh, before and behind the origin

    vec3 span;      // m, of the segment from the origin
    bool outwards;  // only crossings from inside count
    float crossing; // the first, as a share of the span; 2: none
    vec3 normal;    // there, unit, outwards
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

// How the edge from a to b counts for the half line from 0 along +x: 1 if it crosses upwards, -1 if downwards. To the bit
// the opposite of the edge from b to a: whatever rounding does, both triangles of an edge agree on it.
int edge_winding(vec2 a, vec2 b)
{
    precise const float left = a.x * b.y;
    precise const float right = b.x * a.y;
    if (a.y <= 0 && b.y > 0 && left > right)
        return 1;
    return a.y > 0 && b.y <= 0 && left < right ? -1 : 0;
}

// The winding of the triangle as seen along the line (Sunday 2001, "Inclusion of a point in a polygon"). Summed over what a
// closed mesh has on one side of the origin it is the mesh's winding number, also where the line meets edges and vertices.
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
        if (solid.line)
            visit_line(t, normal);
        else
            visit_segment(t, normal);
    }
}

bool boxes_overlap(vec3 a_min, vec3 a_max, vec3 b_min, vec3 b_max)
{
    return all(lessThanEqual(a_min, b_max)) && all(lessThanEqual(b_min, a_max));
}

#include "bvh.glsl"
#include "padded.glsl"

void visit(uint c, ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    solid.deforms = is_deforming(collider.flags);
    if (solid.deforms)
    {
        solid.first_corner = collider_motions[c].first_from;
        visit_padded(collider.first_node, collider.first_triangle, collider.triangles, box_min, box_max);
    }
    else
        visit_box(collider.first_node, collider.first_triangle, box_min, box_max);
}

// How often the mesh winds around a point; `solid.ends` are where the line along the axis meets it last. A box has exactly
// the extent of what is in it: a line along an axis misses none that it should meet.
int line_winding(uint c, ColliderRecord collider, vec3 origin, int axis)
{
    solid.line = true;
    solid.origin = origin;
    solid.axis = axis;
    solid.winding = 0;
    solid.ends[0] = solid.ends[1] = 0;
    vec3 box_min = origin;
    vec3 box_max = origin;
    box_min[axis] = -3e38;
    box_max[axis] = 3e38;
    visit(c, collider, box_min, box_max);
    return solid.winding;
}

// Whether the way from one place to another crosses the mesh; outwards: from inside. The first crossing is in `solid`.
bool crosses(uint c, ColliderRecord collider, vec3 from, vec3 to, bool outwards)
{
    solid.line = false;
    solid.origin = from;
    solid.span = to - from;
    solid.outwards = outwards;
    solid.crossing = 2;
    visit(c, collider, min(from, to), max(from, to));
    return solid.crossing <= 1;
}

#endif
