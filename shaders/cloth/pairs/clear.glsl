// Whether a vertex stays clear of all colliders on its way, until the end of the step, and how those that it may reach sooner
// restrain it. If in doubt, it is not clear.
//
// The including kernel declares colliders[], collider_motions[], bvh_nodes[], bvh_triangles[], padded_boxes[],
// padded_leaves[], deforming_positions[], push (PairPush) and a constant COLLIDERS_MOVE.
#ifndef VOILE_CLEAR_GLSL
#define VOILE_CLEAR_GLSL

#include "colliders/collider_pose.glsl"
#include "colliders/deforming.glsl"
#include "contact/convex.glsl"
#include "pairs/restraints.glsl"
#include "shared/box.glsl"
#include "shared/separation.glsl"

// Of a mesh, so many triangles in the way of a vertex restrain it at most: those that are found first.
const uint k_most_triangles = 64;
// Vertices that stay farther from a collider than this multiple of their thickness are not restrained.
const float k_near = 2;

// The way of a vertex.
struct Way
{
    vec3 x;
    vec3 v;       // m/s
    float time;   // s
    float margin; // m, within which it is not clear
    float near;   // m, within which it is restrained
};

// The same from a collider.
struct RelativeWay
{
    Box wide;     // in the collider's space: where the vertex is not clear
    Box near;     // where it is restrained, in the time of the way
    vec3 from;    // m
    vec3 surface; // m/s, in the world, of the collider there, but for what its vertices do
};

// What of a mesh is in the way of a vertex.
struct WayQuery
{
    RelativeWay way;
    vec3 v; // m/s
    uint collider;
    uint flags;
    bool clear;
    uint count; // of triangles that restrain it
    Restraints restraints;
};

#define VOILE_QUERY WayQuery

bool enters_node(WayQuery query, Box node)
{
    if (query.clear)
        return overlap(query.way.wide, node);
    return query.count < k_most_triangles && overlap(query.way.near, node);
}

vec3 into_world(uint c, uint flags, vec3 direction)
{
    return is_moved(flags) ? rotate(collider_motions[c].rotation_from, direction) : direction;
}

// Within the step.
MovingTriangle triangle_of(WayQuery query, uint triangle)
{
    if (is_deforming(query.flags))
    {
        const ColliderMotion motion = collider_motions[query.collider];
        return moving_triangle(triangle, uvec2(motion.first_from, motion.first_to), vec2(0, 1));
    }
    const BvhTriangle t = bvh_triangles[triangle];
    return MovingTriangle(Triangle(t.a, t.b, t.c), Triangle(t.a, t.b, t.c));
}

Box box_of(Triangle t) { return Box(min(min(t.a, t.b), t.c), max(max(t.a, t.b), t.c)); }

// -1, 0 or 1: on which side of the triangle's plane the box is; 0: on both.
float side_of_plane(Triangle t, Box box)
{
    const vec3 n = cross(t.b - t.a, t.c - t.a);
    const float at = dot(n, 0.5 * (box.min + box.max) - t.a);
    return abs(at) > dot(abs(n), 0.5 * (box.max - box.min)) ? sign(at) : 0;
}

// Whether the triangle may enter the box. The box around a slanted one is much of the space beside it.
bool enters(MovingTriangle t, Box box)
{
    if (!overlap(box, joined(box_of(t.start), box_of(t.end))))
        return false;
    const float side = side_of_plane(t.start, box);
    return side == 0 || side != side_of_plane(t.end, box);
}

// m: how far the triangle moves at its nearest point.
vec3 displacement_at(MovingTriangle t, vec3 point)
{
    const vec3 weights = nearest_weights(t.start.a - point, t.start.b - point, t.start.c - point);
    return weights.x * (t.end.a - t.start.a) + weights.y * (t.end.b - t.start.b) + weights.z * (t.end.c - t.start.c);
}

// Unit, towards a point.
vec3 side_of(Triangle t, vec3 point)
{
    const vec3 across = cross(t.b - t.a, t.c - t.a);
    const vec3 n = across / max(length(across), 1e-30);
    return dot(n, point - t.a) < 0 ? -n : n;
}

void visit_leaf(inout WayQuery query, uint first, uint count)
{
    for (uint k = 0; k < count && (query.clear || query.count < k_most_triangles); ++k)
    {
        const MovingTriangle moving = triangle_of(query, first + k);
        query.clear = query.clear && !enters(moving, query.way.wide);
        if (query.count == k_most_triangles || !enters(moving, query.way.near))
            continue;
        const vec3 n = into_world(query.collider, query.flags, side_of(moving.start, query.way.from));
        const vec3 moved = displacement_at(moving, query.way.from);
        const vec3 deformation = step_input.rate * into_world(query.collider, query.flags, moved);
        restrain(query.restraints, n, query.way.surface + deformation, query.v);
        ++query.count;
    }
}

#include "colliders/mesh_traversal.glsl"

// The largest rate of a rotation along the chord of two quaternions over an even rotation.
const float k_chord_rate = 1.3;

// m: how far a collider moves a point of its space within the step.
float motion_at(ColliderMotion motion, vec3 point)
{
    const float angle = 2 * acos(clamp(abs(dot(motion.rotation_from, motion.rotation_to)), 0, 1));
    return distance(motion.offset_from, motion.offset_to) + k_chord_rate * angle * length(point);
}

// What one collider does to a vertex has the same weight, however many triangles it has.
void add_mesh(inout Restraints restraints, WayQuery query)
{
    if (restraints.wanted && query.count > 0)
        add(restraints, query.restraints, 1 / float(query.count));
}

bool is_clear_of_mesh(inout Restraints restraints, uint c, ColliderRecord collider, RelativeWay relative, vec3 v)
{
    if (!is_deforming(collider.flags) && !overlap(relative.wide, Box(collider.box_min, collider.box_max)))
        return true;
    WayQuery query = WayQuery(relative, v, c, collider.flags, true, 0, no_restraints(restraints.mean, true));
    if (!restraints.wanted)
        query.count = k_most_triangles; // the first triangle suffices
    traverse(query, collider);
    add_mesh(restraints, query);
    return query.clear;
}

// m: of a collider with a formula, from the middle of a box around it, less what the box extends.
ConvexSurface surface_of(ColliderRecord collider, Box box)
{
    const vec3 middle = 0.5 * (box.min + box.max);
    const vec3 half_size = box.max - middle;
    const bool plane = collider.kind == VOILE_COLLIDER_PLANE;
    ConvexSurface surface = plane ? plane_surface(collider, middle) : convex_surface(collider, middle);
    surface.distance -= dot(abs(surface.direction), half_size);
    return surface;
}

bool is_clear_of_shape(inout Restraints restraints, uint c, ColliderRecord collider, RelativeWay relative, vec3 v)
{
    if (surface_of(collider, relative.wide).distance > 0)
        return true;
    const ConvexSurface near = surface_of(collider, relative.near);
    if (restraints.wanted && near.distance <= 0)
        restrain(restraints, into_world(c, collider.flags, near.direction), relative.surface, v);
    return false;
}

RelativeWay relative_way(Way way, uint c, ColliderRecord collider)
{
    vec3 from = way.x - collider.origin;
    vec3 surface = vec3(0);
    vec3 along = way.v;
    vec3 relative = way.v;
    float moved = 0;
    if (is_moved(collider.flags))
    {
        const ColliderMotion motion = collider_motions[c];
        const Pose pose = Pose(motion.rotation_from, motion.offset_from);
        from = to_collider(pose, way.x - motion.origin);
        surface = step_input.rate * displacement(pose, pose_change(c, 0, 1), from);
        along = rotate_back(pose.rotation, along);
        relative = rotate_back(pose.rotation, way.v - surface);
        moved = motion_at(motion, vec3(length(from) + way.time * length(way.v)));
    }
    return RelativeWay(grown(box_around(from, from + step_input.list_time * along), way.margin + moved),
                       grown(box_around(from, from + way.time * relative), way.near), from, surface);
}

bool is_clear_of(inout Restraints restraints, uint c, Way way)
{
    const ColliderRecord collider = colliders[c];
    const RelativeWay relative = relative_way(way, c, collider);
    if (collider.kind == VOILE_COLLIDER_MESH)
        return is_clear_of_mesh(restraints, c, collider, relative, way.v);
    return is_clear_of_shape(restraints, c, collider, relative, way.v);
}

#endif
