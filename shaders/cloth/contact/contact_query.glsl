// The contact of a vertex with a collider, in the collider's space.
//
// The including kernel declares `bvh_nodes[]`, `bvh_triangles[]`, `padded_boxes[]`, `padded_leaves[]` and
// `deforming_positions[]`, a constant COLLIDERS_CONVEX (0: planes are the only colliders with a formula), and defines
//   void visit_mesh(uint c, ColliderRecord collider, Box box)
// after the include. It calls visit_triangle for all triangles of collider c that overlap the box.
#ifndef VOILE_CONTACT_QUERY_GLSL
#define VOILE_CONTACT_QUERY_GLSL

#include "contact/convex.glsl"
#include "colliders/deforming.glsl"
#include "contact/triangle.glsl"
#include "shared/box.glsl"

// How the narrow phase finds the surface within the thickness. The first two are those of ContactMethod.
const int k_method_normal_ray = 0;    // the nearest hit of two rays, along the vertex normal and its opposite
const int k_method_nearest_point = 1; // the nearest point of the mesh
const int k_method_path_only = 2;     // only what the path crosses

// Offsets from the nearest point shorter than this fraction of the thickness have no precise direction.
const float k_short_offset = 0.01;
// |cosine| between the offset and the face normal. Behind an open one-sided mesh the nearest point lies straight ahead,
// within this bound; beside the mesh it does not.
const float k_behind = 0.99;

struct Contact
{
    bool found;
    vec3 direction; // unit, from the surface to the side on which the vertex belongs
    float gap;      // m, distance of the vertex from the surface along `direction`; negative under the surface
    float start;    // m, the same at the start of the substep
    vec3 deformation; // m, displacement of the surface there within the substep, by its own vertices
};

// Progress of the step, 0..1, at the substep's start and end: where deforming meshes are.
vec2 query_progress = vec2(1);
// Of the vertex's cloth. Tested together with boxes: on some drivers a branch around the queries halves their speed
// (bench/NOTES.md).
uint query_layers = 0;

// The query of a vertex that moves from `from` to `to` within the substep, and its result so far.
struct MeshQuery
{
    int method;
    vec3 from;
    vec3 to;
    vec3 normal;     // of the cloth at the vertex, for k_method_normal_ray
    float thickness; // m
    bool one_sided;
    bool closed;
    bool deforms;
    uvec2 first_corner; // of a mesh that deforms: its first vertex at the start and at the end of the step

    uint current;    // the triangle being tested
    uint triangle;   // the nearest
    float distance;  // m to the nearest surface found; starts at the thickness
    float alignment; // |cosine| between the offset from `point` and the face normal; breaks ties at shared edges
    vec3 point;      // on that surface
    vec3 face;       // unit normal of its triangle
    float height;    // m, of `to` above the triangle's plane
    uint crossing_triangle;
    float crossing;  // smallest parameter of from -> to at which the path crosses a triangle; 2: none
    vec3 crossing_face; // towards the side that the path comes from
    vec3 crossing_point;
};
MeshQuery query;

// m: distances that differ by less are equal within rounding.
float query_tie() { return 1e-5 * query.thickness; }

void visit_nearest(vec3 a, vec3 b, vec3 c, vec3 face)
{
    const vec3 point = nearest_on_triangle(query.to, a, b, c);
    const vec3 offset = query.to - point;
    const float distance = length(offset);
    const float alignment = abs(dot(offset, face)) / max(distance, 1e-12);
    // Triangles that share the nearest edge or vertex are equally far. The one that faces the vertex most decides the
    // side (Ericson 2004, 12.3).
    const bool nearer = distance < query.distance - query_tie();
    const bool better_facing = distance < query.distance + query_tie() && alignment > query.alignment;
    if (nearer || better_facing)
    {
        query.triangle = query.current;
        query.distance = distance;
        query.alignment = alignment;
        query.point = point;
        query.face = face;
        query.height = dot(query.to - a, face); // more precise than from `point`, a sum over the corners
    }
}

void visit_normal_ray(vec3 a, vec3 b, vec3 c, vec3 face)
{
    const vec3 ray = query.thickness * query.normal;
    const float t = segment_triangle(query.to - ray, 2 * ray, a, b, c);
    const float distance = abs(2 * t - 1) * query.thickness;
    if (t <= 1 && distance < query.distance)
    {
        query.triangle = query.current;
        query.distance = distance;
        query.point = query.to + (2 * t - 1) * ray;
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
    const vec3 face = normal / max(length(normal), 1e-30); // 0 for a collapsed triangle
    query.current = index;
    const float t = segment_triangle(from, query.to - from, triangle.a, triangle.b, triangle.c);
    // Leaving a solid is no crossing.
    if (t < query.crossing && !(query.one_sided && dot(query.to - from, face) >= 0))
    {
        query.crossing = t;
        query.crossing_triangle = index;
        query.crossing_face = dot(from - query.to, face) >= 0 ? face : -face;
        query.crossing_point = from + t * (query.to - from);
    }
    if (query.method == k_method_normal_ray)
        visit_normal_ray(triangle.a, triangle.b, triangle.c, face);
    else if (query.method == k_method_nearest_point)
        visit_nearest(triangle.a, triangle.b, triangle.c, face);
}

void visit_mesh(uint c, ColliderRecord collider, Box box);

bool shares_layer(ColliderRecord collider) { return (collider.layers & query_layers) != 0; }

// Whether a box overlaps the box of a mesh on a layer of the cloth.
bool overlaps_mesh(ColliderRecord collider, Box box)
{
    if (!is_deforming(collider.flags))
        return shares_layer(collider) && overlap(box, Box(collider.box_min, collider.box_max));
    const PaddedBox root = padded_boxes[collider.first_node];
    return shares_layer(collider) && overlap(box, Box(root.min, root.max));
}

// m: the displacement within the substep of a triangle's point, by the mesh's own vertices.
vec3 deformation_at(uint triangle, vec3 point)
{
    if (!query.deforms)
        return vec3(0);
    return triangle_displacement(moving_triangle(triangle, query.first_corner, query_progress), point);
}

// m: the gap from the contact's plane at the start of the substep.
float start_gap(Contact contact)
{
    return contact.gap - dot(query.to - query.from - contact.deformation, contact.direction);
}

Contact crossing_contact()
{
    Contact contact;
    contact.found = true;
    contact.direction = query.crossing_face;
    contact.gap = dot(query.to - query.crossing_point, contact.direction);
    contact.deformation = deformation_at(query.crossing_triangle, query.crossing_point);
    contact.start = max(start_gap(contact), 0); // the path begins on the right side
    return contact;
}

Contact nearest_contact()
{
    Contact contact;
    contact.found = query.distance < query.thickness;
    if (!contact.found)
        return contact;
    contact.deformation = deformation_at(query.triangle, query.point);
    const vec3 offset = query.to - query.point;
    const bool inside = query.one_sided && dot(offset, query.face) < 0;
    // Behind an open mesh and nearest to its border: the vertex is beside the mesh.
    if (inside && !query.closed && query.alignment < k_behind)
        contact.found = false;
    // The face gives the direction where the offset has no precise one: near the surface; for a hit of a ray, whose
    // offset follows the cloth; and above the triangle's inside, where rounding of large coordinates would tilt the
    // offset.
    const bool short_offset = query.distance < k_short_offset * query.thickness;
    const vec3 beside = offset - dot(offset, query.face) * query.face;
    const bool inside_face = query.method == k_method_nearest_point && length(beside) < rounding(query.to);
    if (short_offset || inside_face || query.method == k_method_normal_ray)
    {
        const vec3 side = query.method == k_method_normal_ray ? query.from - query.point : offset;
        const bool flip = !query.one_sided && dot(side, query.face) < 0;
        contact.direction = flip ? -query.face : query.face;
        contact.gap = inside_face ? (flip ? -query.height : query.height) : dot(offset, contact.direction);
    }
    else
    {
        contact.direction = (inside ? -1 : 1) * offset / query.distance;
        contact.gap = inside ? -query.distance : query.distance;
    }
    // A vertex that is outside now and was under this plane came around an edge.
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
    query.alignment = 2; // no triangle ties with the initial distance
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
    const Box box = Box(min(to - thickness, from), max(to + thickness, from));
    if (!overlaps_mesh(collider, box))
        return no_contact();
    begin_query(c, collider, method, from, to, normal, thickness);
    visit_mesh(c, collider, box);
    if (query.crossing <= 1)
        return crossing_contact();
    return nearest_contact();
}

// `start`: m, distance of the vertex from the surface at the start of the substep.
Contact surface_contact(ColliderRecord collider, ConvexSurface surface, float start, float thickness)
{
    return Contact(surface.distance < thickness && shares_layer(collider), surface.direction, surface.distance, start, vec3(0));
}

// The plane at which a path that starts outside enters a solid. A path shorter than the sum of its ends' distances from
// the solid does not enter it.
Contact convex_crossing(ColliderRecord collider, vec3 from, vec3 to, float start, float end)
{
    if (start <= 0 || start + end >= distance(from, to))
        return no_contact();
    const Entry entry = convex_entry(collider, from, to);
    const float gap = (1 - entry.time) * dot(to - from, entry.direction);
    return Contact(entry.time <= 1 && shares_layer(collider), entry.direction, gap, start, vec3(0));
}

// The nearest surface. If the path enters the solid and the nearest surface is on another side: the plane of the entry.
Contact convex_contact(ColliderRecord collider, int method, vec3 from, vec3 to, float thickness)
{
    const ConvexSurface end = convex_surface(collider, to);
    const float start = convex_surface(collider, from).distance;
    const Contact crossing = convex_crossing(collider, from, to, start, end.distance);
    const bool same_side = end.distance < thickness && dot(end.direction, crossing.direction) > 0.5;
    if (method == k_method_path_only || (crossing.found && !same_side))
        return crossing;
    return surface_contact(collider, end, start, thickness);
}

Contact plane_contact(ColliderRecord collider, vec3 from, vec3 to, float thickness)
{
    return surface_contact(collider, plane_surface(collider, to), plane_surface(collider, from).distance, thickness);
}

// The contact of a vertex that moves from `from` to `to`. k_method_path_only: where the path enters a solid or crosses
// a mesh; the thickness is 0 then.
Contact find_contact(uint c, ColliderRecord collider, int method, vec3 from, vec3 to, vec3 normal, float thickness)
{
    if (collider.kind == VOILE_COLLIDER_MESH)
        return mesh_contact(c, collider, method, from, to, normal, thickness);
    if (COLLIDERS_CONVEX != 0 && collider.kind != VOILE_COLLIDER_PLANE)
        return convex_contact(collider, method, from, to, thickness);
    if (method == k_method_path_only)
        return no_contact();
    return plane_contact(collider, from, to, thickness);
}

#endif
