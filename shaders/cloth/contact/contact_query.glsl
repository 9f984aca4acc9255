// Where a vertex touches a collider.
//
// All of this is in the collider's space. The including kernel declares `bvh_nodes[]`, `bvh_triangles[]`, `padded_boxes[]`,
// `padded_leaves[]` and `deforming_positions[]`, a constant COLLIDERS_CONVEX (0 where the only colliders with a formula are
// planes), and defines
//   void visit_mesh(uint c, ColliderRecord collider, vec3 box_min, vec3 box_max)
// after the include, which calls visit_triangle for all triangles of collider c that the box can reach.
#ifndef VOILE_CONTACT_QUERY_GLSL
#define VOILE_CONTACT_QUERY_GLSL

#include "contact/convex.glsl"
#include "colliders/deforming.glsl"
#include "contact/triangle.glsl"

// How the narrow phase finds the surface within the thickness.
#define VOILE_METHOD_NORMAL_RAY 0    // a ray along the vertex normal and one along its opposite, the nearest hit
#define VOILE_METHOD_NEAREST_POINT 1 // the nearest point of the mesh
#define VOILE_METHOD_PATH_ALONE 2    // nothing but what the path crosses

// Offsets from the nearest point that are shorter than this share of the thickness are too short for a direction.
#define VOILE_SHORT_OFFSET 0.01
// What lies behind an open mesh with one side has its nearest point straight before it: |cosine| to the face's normal.
#define VOILE_BEHIND 0.99

struct Contact
{
    bool found;
    vec3 direction; // unit, from the surface to the side on which the vertex belongs
    float gap;      // m, distance of the vertex from the surface along `direction`; negative under the surface
    float start;    // m, the same at the start of the substep
    vec3 way;       // m, by which the surface deforms there in the substep
};

// Of the substep as shares of the step: where deforming meshes are at its start and at its end.
vec2 query_progress = vec2(1);
// Of the vertex's cloth. It is asked where boxes are: on some drivers a branch of its own around the queries costs them half
// of their speed (bench/NOTES.md).
uint query_layers = 0;

// A vertex that moves from `from` to `to` within the substep, and what its traversal has found so far.
struct MeshQuery
{
    int method;
    vec3 from;
    vec3 to;
    vec3 normal;     // of the cloth at the vertex, for VOILE_METHOD_NORMAL_RAY
    float thickness; // m
    bool one_sided;
    bool closed;
    bool deforms;
    uvec2 first_corner; // of a mesh that deforms: its first vertex at the start and at the end of the step

    uint visited;    // the triangle that is being looked at
    uint triangle;   // the nearest
    float distance;  // m to the nearest surface found; starts at the thickness
    float alignment; // |cosine| between the offset from `point` and the face normal: breaks ties at shared edges
    vec3 point;      // on that surface
    vec3 face;       // unit normal of its triangle
    float height;    // m, of `to` above the triangle's plane
    uint crossing_triangle;
    float crossing;  // smallest parameter of from -> to at which the motion crosses a triangle; 2 = none
    vec3 crossing_face; // to the side that the motion comes from
    vec3 crossing_point;
};
MeshQuery query;

// m: distances within a few roundings count as equal.
float query_tie() { return 1e-5 * query.thickness; }

void visit_nearest(vec3 a, vec3 b, vec3 c, vec3 face)
{
    const vec3 point = nearest_on_triangle(query.to, a, b, c);
    const vec3 offset = query.to - point;
    const float distance = length(offset);
    const float alignment = abs(dot(offset, face)) / max(distance, 1e-12);
    // Triangles that share the nearest edge or vertex lie equally far; the one that faces the vertex most tells the side
    // (Ericson 2004, 12.3).
    const bool nearer = distance < query.distance - query_tie();
    const bool better_facing = distance < query.distance + query_tie() && alignment > query.alignment;
    if (nearer || better_facing)
    {
        query.triangle = query.visited;
        query.distance = distance;
        query.alignment = alignment;
        query.point = point;
        query.face = face;
        query.height = dot(query.to - a, face); // more precise than by the point, which is put together from corners
    }
}

void visit_normal_ray(vec3 a, vec3 b, vec3 c, vec3 face)
{
    const vec3 reach = query.thickness * query.normal;
    const float t = segment_triangle(query.to - reach, 2 * reach, a, b, c);
    const float distance = abs(2 * t - 1) * query.thickness;
    if (t <= 1 && distance < query.distance)
    {
        query.triangle = query.visited;
        query.distance = distance;
        query.point = query.to + (2 * t - 1) * reach;
        query.face = face;
    }
}

void visit_triangle(uint index)
{
    vec3 from = query.from;
    Triangle triangle;
    if (query.deforms)
    {
        const MovingTriangle moving = moving_triangle(index, query.first_corner, query_progress);
        triangle = moving.end;
        from = carried(moving, from);
    }
    else
    {
        const BvhTriangle stored = bvh_triangles[index];
        triangle = Triangle(stored.a, stored.b, stored.c);
    }
    const vec3 normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const vec3 face = normal / max(length(normal), 1e-30); // 0 of a collapsed one
    query.visited = index;
    const float t = segment_triangle(from, query.to - from, triangle.a, triangle.b, triangle.c);
    // Leaving a solid through its surface is no fault.
    if (t < query.crossing && !(query.one_sided && dot(query.to - from, face) >= 0))
    {
        query.crossing = t;
        query.crossing_triangle = index;
        query.crossing_face = dot(from - query.to, face) >= 0 ? face : -face;
        query.crossing_point = from + t * (query.to - from);
    }
    if (query.method == VOILE_METHOD_NORMAL_RAY)
        visit_normal_ray(triangle.a, triangle.b, triangle.c, face);
    else if (query.method == VOILE_METHOD_NEAREST_POINT)
        visit_nearest(triangle.a, triangle.b, triangle.c, face);
}

bool boxes_overlap(vec3 a_min, vec3 a_max, vec3 b_min, vec3 b_max)
{
    return all(lessThanEqual(a_min, b_max)) && all(lessThanEqual(b_min, a_max));
}

void visit_mesh(uint c, ColliderRecord collider, vec3 box_min, vec3 box_max);

bool meets(ColliderRecord collider) { return (collider.layers & query_layers) != 0; }

// Whether a box may reach something of a mesh that the cloth meets.
bool reaches(ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    if (!is_deforming(collider.flags))
        return meets(collider) && boxes_overlap(box_min, box_max, collider.box_min, collider.box_max);
    const PaddedBox root = padded_boxes[collider.first_node];
    return meets(collider) && boxes_overlap(box_min, box_max, root.min, root.max);
}

// By how much the surface deforms in the substep at a point of a triangle.
vec3 deformation_way(uint triangle, vec3 point)
{
    if (!query.deforms)
        return vec3(0);
    return way_of(moving_triangle(triangle, query.first_corner, query_progress), point);
}

// The gap that a contact had at the start of the substep, by its plane.
float start_gap(Contact contact)
{
    return contact.gap - dot(query.to - query.from - contact.way, contact.direction);
}

Contact crossing_contact()
{
    Contact contact;
    contact.found = true;
    contact.direction = query.crossing_face;
    contact.gap = dot(query.to - query.crossing_point, contact.direction);
    contact.way = deformation_way(query.crossing_triangle, query.crossing_point);
    contact.start = max(start_gap(contact), 0); // it came from the right side
    return contact;
}

Contact nearest_contact()
{
    Contact contact;
    contact.found = query.distance < query.thickness;
    if (!contact.found)
        return contact;
    contact.way = deformation_way(query.triangle, query.point);
    const vec3 offset = query.to - query.point;
    const bool inside = query.one_sided && dot(offset, query.face) < 0;
    // Behind an open mesh, but nearest to its border: beside it.
    if (inside && !query.closed && query.alignment < VOILE_BEHIND)
        contact.found = false;
    // Near the surface the offset is too short to have a precise direction; the face has one. So it has for a ray's hit,
    // whose offset follows the cloth, and inside the triangle, where rounding of large coordinates would tilt the offset.
    const bool short_offset = query.distance < VOILE_SHORT_OFFSET * query.thickness;
    const vec3 beside = offset - dot(offset, query.face) * query.face;
    const bool inside_face = query.method == VOILE_METHOD_NEAREST_POINT && length(beside) < rounding(query.to);
    if (short_offset || inside_face || query.method == VOILE_METHOD_NORMAL_RAY)
    {
        const vec3 side = query.method == VOILE_METHOD_NORMAL_RAY ? query.from - query.point : offset;
        const bool flip = !query.one_sided && dot(side, query.face) < 0;
        contact.direction = flip ? -query.face : query.face;
        contact.gap = inside_face ? (flip ? -query.height : query.height) : dot(offset, contact.direction);
    }
    else
    {
        contact.direction = (inside ? -1 : 1) * offset / query.distance;
        contact.gap = inside ? -query.distance : query.distance;
    }
    // What is outside now and was under this plane came round an edge.
    contact.start = contact.gap < 0 ? start_gap(contact) : max(start_gap(contact), 0);
    return contact;
}

void begin_query(uint c, ColliderRecord collider, int method, vec3 from, vec3 to, vec3 normal, float thickness)
{
    query.method = method;
    query.from = from;
    query.to = to;
    query.normal = normal;
    query.thickness = thickness;
    query.one_sided = (collider.flags & VOILE_COLLIDER_ONE_SIDED) != 0;
    query.closed = (collider.flags & VOILE_COLLIDER_CLOSED) != 0;
    query.deforms = is_deforming(collider.flags);
    if (query.deforms)
        query.first_corner = uvec2(collider_motions[c].first_from, collider_motions[c].first_to);
    query.distance = thickness;
    query.alignment = 2; // nothing ties with "nothing found"
    query.crossing = 2;
}

Contact no_contact()
{
    Contact none;
    none.found = false;
    return none;
}

Contact mesh_contact(uint c, ColliderRecord collider, int method, vec3 from, vec3 to, vec3 normal, float thickness)
{
    const vec3 box_min = min(to - thickness, from);
    const vec3 box_max = max(to + thickness, from);
    if (!reaches(collider, box_min, box_max))
        return no_contact();
    begin_query(c, collider, method, from, to, normal, thickness);
    visit_mesh(c, collider, box_min, box_max);
    if (query.crossing <= 1)
        return crossing_contact();
    return nearest_contact();
}

// `start`: m, how far the vertex was from the surface at the start of the substep.
Contact surface_contact(ColliderRecord collider, ConvexSurface surface, float start, float thickness)
{
    return Contact(surface.distance < thickness && meets(collider), surface.direction, surface.distance, start, vec3(0));
}

// Where a path that starts outside enters a solid: the plane on which it does. A path shorter than the distances of its ends
// from the solid does not.
Contact convex_crossing(ColliderRecord collider, vec3 from, vec3 to, float start, float end)
{
    if (start <= 0 || start + end >= distance(from, to))
        return no_contact();
    const Entry entry = convex_entry(collider, from, to);
    const float gap = (1 - entry.time) * dot(to - from, entry.direction);
    return Contact(entry.time <= 1 && meets(collider), entry.direction, gap, start, vec3(0));
}

// The nearest surface, or, where the path enters the solid and would come out of another side of it, the plane on which it
// entered.
Contact convex_contact(ColliderRecord collider, int method, vec3 from, vec3 to, float thickness)
{
    const ConvexSurface end = convex_surface(collider, to);
    const float start = convex_surface(collider, from).distance;
    const Contact crossing = convex_crossing(collider, from, to, start, end.distance);
    const bool same_side = end.distance < thickness && dot(end.direction, crossing.direction) > 0.5;
    if (method == VOILE_METHOD_PATH_ALONE || (crossing.found && !same_side))
        return crossing;
    return surface_contact(collider, end, start, thickness);
}

Contact plane_contact(ColliderRecord collider, vec3 from, vec3 to, float thickness)
{
    return surface_contact(collider, plane_surface(collider, to), plane_surface(collider, from).distance, thickness);
}

// What a vertex that goes from `from` to `to` touches of collider c. VOILE_METHOD_PATH_ALONE: the side through which the path
// enters a solid or crosses a mesh; the thickness is 0 then.
Contact find_contact(uint c, ColliderRecord collider, int method, vec3 from, vec3 to, vec3 normal, float thickness)
{
    if (collider.kind == VOILE_COLLIDER_MESH)
        return mesh_contact(c, collider, method, from, to, normal, thickness);
    if (COLLIDERS_CONVEX != 0 && collider.kind != VOILE_COLLIDER_PLANE)
        return convex_contact(collider, method, from, to, thickness);
    if (method == VOILE_METHOD_PATH_ALONE)
        return no_contact();
    return plane_contact(collider, from, to, thickness);
}

#endif
