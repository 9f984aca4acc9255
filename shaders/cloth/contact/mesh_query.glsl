// The query of a vertex's path against the triangles of a mesh, in the collider's space.
//
// The including kernel declares `bvh_nodes[]`, `bvh_triangles[]`, `padded_boxes[]`, `padded_leaves[]`,
// `deforming_positions[]` and `push` (ContactPush), and includes collider_pose.glsl before.
#ifndef VOILE_MESH_QUERY_GLSL
#define VOILE_MESH_QUERY_GLSL

#include "colliders/deforming.glsl"
#include "contact/rounding.glsl"
#include "contact/triangle.glsl"
#include "shared/box.glsl"

// How the narrow phase finds the surface within the query radius. The first two are those of ContactMethod.
const int k_method_normal_ray = 0;    // the nearest hit of two rays, along the vertex normal and its opposite
const int k_method_nearest_point = 1; // the nearest point of the mesh
const int k_method_path_only = 2;     // only what the path crosses

// The path of a vertex within the substep, in the collider's space.
struct Path
{
    int method;
    vec3 from;
    vec3 to;
    vec3 normal;  // of the cloth at the vertex, for k_method_normal_ray
    float radius; // m, the query radius; 0 for k_method_path_only
    uint layers;  // of the cloth
};

// The query of a path and its result so far.
struct MeshQuery
{
    Path path;
    Box box; // around all that the query may find
    bool one_sided;
    bool closed;
    bool deforms;
    uvec2 first_corner; // of a mesh that deforms: its first vertex at the start and at the end of the step

    uint current;    // the triangle being tested
    uint triangle;   // the nearest
    float distance;  // m to the nearest surface found; starts at the query radius
    float alignment; // |cosine| between the offset from `point` and the face normal; breaks ties at shared edges
    vec3 point;      // on that surface
    vec3 face;       // unit normal of its triangle
    float height;    // m, of the path's end above the triangle's plane
    uint crossing_triangle;
    float crossing;     // smallest parameter of the path at which it crosses a triangle; 2: none
    vec3 crossing_face; // towards the side that the path comes from
    vec3 crossing_point;
};

// Progress of the step, 0..1, at the substep's start and end.
vec2 substep_progress() { return vec2(push.progress_from, push.progress_to); }

// m: distances that differ by less are equal within rounding.
float query_tie(MeshQuery query) { return 1e-5 * query.path.radius; }

void visit_nearest(inout MeshQuery query, Triangle t, vec3 face)
{
    const vec3 point = nearest_on_triangle(query.path.to, t.a, t.b, t.c);
    const vec3 offset = query.path.to - point;
    const float distance = length(offset);
    const float alignment = abs(dot(offset, face)) / max(distance, 1e-12);
    // Triangles that share the nearest edge or vertex are equally far. The one that faces the vertex most decides the
    // side (Ericson 2004, 12.3).
    const bool nearer = distance < query.distance - query_tie(query);
    const bool better_facing = distance < query.distance + query_tie(query) && alignment > query.alignment;
    if (nearer || better_facing)
    {
        query.triangle = query.current;
        query.distance = distance;
        query.alignment = alignment;
        query.point = point;
        query.face = face;
        query.height = dot(query.path.to - t.a, face); // more precise than from `point`, a sum over the corners
    }
}

void visit_normal_ray(inout MeshQuery query, Triangle triangle, vec3 face)
{
    const vec3 ray = query.path.radius * query.path.normal;
    const float t = segment_triangle(query.path.to - ray, 2 * ray, triangle.a, triangle.b, triangle.c);
    const float distance = abs(2 * t - 1) * query.path.radius;
    if (t <= 1 && distance < query.distance)
    {
        query.triangle = query.current;
        query.distance = distance;
        query.point = query.path.to + (2 * t - 1) * ray;
        query.face = face;
    }
}

void visit_triangle(inout MeshQuery query, uint index)
{
    vec3 from = query.path.from;
    Triangle triangle;
    if (query.deforms)
    {
        const MovingTriangle moving = moving_triangle(index, query.first_corner, substep_progress());
        triangle = moving.end;
        from = carried(moving, from);
    }
    else
    {
        const BvhTriangle stored = bvh_triangles[index];
        triangle = Triangle(stored.a, stored.b, stored.c);
    }
    const vec3 normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const vec3 face = normal / max(length(normal), 1e-30); // 0 for a collapsed triangle
    query.current = index;
    const float t = segment_triangle(from, query.path.to - from, triangle.a, triangle.b, triangle.c);
    // Leaving a solid is no crossing.
    if (t < query.crossing && !(query.one_sided && dot(query.path.to - from, face) >= 0))
    {
        query.crossing = t;
        query.crossing_triangle = index;
        query.crossing_face = dot(from - query.path.to, face) >= 0 ? face : -face;
        query.crossing_point = from + t * (query.path.to - from);
    }
    if (query.path.method == k_method_normal_ray)
        visit_normal_ray(query, triangle, face);
    else if (query.path.method == k_method_nearest_point)
        visit_nearest(query, triangle, face);
}

// Whether a traversal enters a node's box: if it may contain something closer than the nearest so far, or overlaps the
// path. Boxes of a deforming mesh cover its motion within the step, so the path alone decides there, too.
bool enters_node(MeshQuery query, Box node)
{
    const vec3 to = query.path.to;
    const float nearest = query.distance + 10 * query_tie(query) + rounding(to);
    return overlap(query.box, node) && (distance(to, clamp(to, node.min, node.max)) <= nearest ||
                                        overlap(box_around(query.path.from, to), node));
}

void visit_leaf(inout MeshQuery query, uint first, uint count)
{
    for (uint t = first; t < first + count; ++t)
        visit_triangle(query, t);
}

#define VOILE_QUERY MeshQuery
#include "colliders/mesh_traversal.glsl"
#undef VOILE_QUERY

bool shares_layer(ColliderRecord collider, uint layers) { return (collider.layers & layers) != 0; }

// Whether a box overlaps the box of a mesh on a layer of the cloth. One test for both: on some drivers a branch around
// the queries halves their speed (bench/NOTES.md).
bool overlaps_mesh(ColliderRecord collider, uint layers, Box box)
{
    if (!is_deforming(collider.flags))
        return shares_layer(collider, layers) && overlap(box, Box(collider.box_min, collider.box_max));
    return shares_layer(collider, layers) && overlap(box, padded_box(collider.first_node));
}

MeshQuery mesh_query(uint c, ColliderRecord collider, Path path)
{
    MeshQuery query;
    query.path = path;
    query.box = Box(min(path.to - path.radius, path.from), max(path.to + path.radius, path.from));
    query.one_sided = (collider.flags & VOILE_COLLIDER_ONE_SIDED) != 0;
    query.closed = (collider.flags & VOILE_COLLIDER_CLOSED) != 0;
    query.deforms = is_deforming(collider.flags);
    if (query.deforms)
        query.first_corner = uvec2(collider_motions[c].first_from, collider_motions[c].first_to);
    query.distance = path.radius;
    query.alignment = 2; // no triangle ties with the initial distance
    query.crossing = 2;
    return query;
}

#endif
