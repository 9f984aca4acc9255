// The contact of a vertex with a collider, in the collider's space.
//
// The including kernel declares a constant COLLIDERS_CONVEX (0: planes are the only colliders with a formula) and what
// contact_candidates.glsl expects.
#ifndef VOILE_CONTACT_QUERY_GLSL
#define VOILE_CONTACT_QUERY_GLSL

#include "contact/contact_candidates.glsl"
#include "contact/convex.glsl"
#include "contact/mesh_query.glsl"

// Offsets from the nearest point shorter than this fraction of the query radius have no precise direction.
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

// m: the displacement within the substep of a triangle's point, by the mesh's own vertices.
vec3 deformation_at(MeshQuery query, uint triangle, vec3 point)
{
    if (!query.deforms)
        return vec3(0);
    return triangle_displacement(moving_triangle(triangle, query.first_corner, substep_progress()), point);
}

// m: the gap from the contact's plane at the start of the substep.
float start_gap(MeshQuery query, Contact contact)
{
    return contact.gap - dot(query.path.to - query.path.from - contact.deformation, contact.direction);
}

Contact crossing_contact(MeshQuery query)
{
    Contact contact;
    contact.found = true;
    contact.direction = query.crossing_face;
    contact.gap = dot(query.path.to - query.crossing_point, contact.direction);
    contact.deformation = deformation_at(query, query.crossing_triangle, query.crossing_point);
    contact.start = max(start_gap(query, contact), 0); // the path begins on the right side
    return contact;
}

Contact nearest_contact(MeshQuery query)
{
    Contact contact;
    contact.found = query.distance < query.path.radius;
    if (!contact.found)
        return contact;
    contact.deformation = deformation_at(query, query.triangle, query.point);
    const vec3 offset = query.path.to - query.point;
    const bool inside = query.one_sided && dot(offset, query.face) < 0;
    // Behind an open mesh and nearest to its border: the vertex is beside the mesh.
    if (inside && !query.closed && query.alignment < k_behind)
        contact.found = false;
    // The face gives the direction where the offset has no precise one: near the surface; for a hit of a ray, whose
    // offset follows the cloth; and above the triangle's inside, where rounding of large coordinates would tilt the
    // offset.
    const bool short_offset = query.distance < k_short_offset * query.path.radius;
    const vec3 beside = offset - dot(offset, query.face) * query.face;
    const bool inside_face = query.path.method == k_method_nearest_point && length(beside) < rounding(query.path.to);
    if (short_offset || inside_face || query.path.method == k_method_normal_ray)
    {
        const vec3 side = query.path.method == k_method_normal_ray ? query.path.from - query.point : offset;
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
    contact.start = contact.gap < 0 ? start_gap(query, contact) : max(start_gap(query, contact), 0);
    return contact;
}

Contact no_contact()
{
    Contact none;
    none.found = false;
    return none;
}

Contact mesh_contact(uint c, ColliderRecord collider, Path path, Motion motion, ClothContact cloth, inout Candidates list)
{
    MeshQuery query = mesh_query(c, collider, path);
    // When all lists are refreshed, so are those of vertices that may get near.
    const float ahead = COLLIDERS_MOVE == 0 || push.refresh == 0 ? 0 : distance_ahead(distance(path.from, path.to), is_deforming(collider.flags));
    if (!overlaps_mesh(collider, path.layers, grown(query.box, ahead)))
        return no_contact();
    visit_mesh(query, list, c, collider, motion, cloth);
    if (query.crossing <= 1)
        return crossing_contact(query);
    return nearest_contact(query);
}

// `start`: m, distance of the vertex from the surface at the start of the substep.
Contact surface_contact(ColliderRecord collider, Path path, ConvexSurface surface, float start)
{
    const bool found = surface.distance < path.radius && shares_layer(collider, path.layers);
    return Contact(found, surface.direction, surface.distance, start, vec3(0));
}

// The plane at which a path that starts outside enters a solid. A path shorter than the sum of its ends' distances from
// the solid does not enter it.
Contact convex_crossing(ColliderRecord collider, Path path, float start, float end)
{
    if (start <= 0 || start + end >= distance(path.from, path.to))
        return no_contact();
    const Entry entry = convex_entry(collider, path.from, path.to);
    const float gap = (1 - entry.time) * dot(path.to - path.from, entry.direction);
    const bool found = entry.time <= 1 && shares_layer(collider, path.layers);
    return Contact(found, entry.direction, gap, start, vec3(0));
}

// The nearest surface. If the path enters the solid and the nearest surface is on another side: the plane of the entry.
Contact convex_contact(ColliderRecord collider, Path path)
{
    const ConvexSurface end = convex_surface(collider, path.to);
    const float start = convex_surface(collider, path.from).distance;
    const Contact crossing = convex_crossing(collider, path, start, end.distance);
    const bool same_side = end.distance < path.radius && dot(end.direction, crossing.direction) > 0.5;
    if (path.method == k_method_path_only || (crossing.found && !same_side))
        return crossing;
    return surface_contact(collider, path, end, start);
}

Contact plane_contact(ColliderRecord collider, Path path)
{
    return surface_contact(collider, path, plane_surface(collider, path.to),
                           plane_surface(collider, path.from).distance);
}

// The contact of a vertex with collider c. k_method_path_only: where the path enters a solid or crosses a mesh.
// `motion`: of which `path` is that in the collider's space.
Contact find_contact(uint c, ColliderRecord collider, Path path, Motion motion, ClothContact cloth, inout Candidates list)
{
    if (collider.kind == VOILE_COLLIDER_MESH)
        return mesh_contact(c, collider, path, motion, cloth, list);
    if (COLLIDERS_CONVEX != 0 && collider.kind != VOILE_COLLIDER_PLANE)
        return convex_contact(collider, path);
    if (path.method == k_method_path_only)
        return no_contact();
    return plane_contact(collider, path);
}

#endif
