// Whether a vertex stays clear of all colliders on its way, until the end of the step. If in doubt, it does not.
//
// The including kernel declares colliders[], collider_motions[], bvh_nodes[], padded_boxes[], push.colliders and a
// constant COLLIDERS_MOVE.
#ifndef VOILE_CLEAR_GLSL
#define VOILE_CLEAR_GLSL

#include "colliders/collider_pose.glsl"
#include "contact/convex.glsl"
#include "shared/box.glsl"

// Around the way of a vertex in the space of a collider.
struct Way
{
    Box box;
    bool clear;
};

#define VOILE_QUERY Way

// The first leaf in the way suffices.
bool enters_node(Way way, Box node) { return way.clear && overlap(way.box, node); }
void visit_leaf(inout Way way, uint first, uint count) { way.clear = false; }

#include "colliders/mesh_traversal.glsl"

// The largest rate of a rotation along the chord of two quaternions over an even rotation.
const float k_chord_rate = 1.3;

// m: how far a collider moves a point of its space within the step.
float motion_at(ColliderMotion motion, vec3 point)
{
    const float angle = 2 * acos(clamp(abs(dot(motion.rotation_from, motion.rotation_to)), 0, 1));
    return distance(motion.offset_from, motion.offset_to) + k_chord_rate * angle * length(point);
}

// From `from` to `from + way`, in the collider's space.
bool is_clear_of(ColliderRecord collider, vec3 from, vec3 way, float margin)
{
    const vec3 middle = from + 0.5 * way;
    const float radius = 0.5 * length(way) + margin;
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return min(plane_surface(collider, from).distance, plane_surface(collider, from + way).distance) > margin;
    if (collider.kind != VOILE_COLLIDER_MESH)
        return convex_surface(collider, middle).distance > radius;
    Way query = Way(grown(box_around(from, from + way), margin), true);
    if (is_deforming(collider.flags) || overlap(query.box, Box(collider.box_min, collider.box_max)))
        traverse(query, collider);
    return query.clear;
}

// `way`: m, from x on.
bool is_clear(vec3 x, vec3 way, float margin, uint layers)
{
    for (uint c = 0; c < push.colliders; ++c)
    {
        const ColliderRecord collider = colliders[c];
        if ((collider.layers & layers) == 0)
            continue;
        vec3 from = x - collider.origin;
        vec3 along = way;
        float moved = 0;
        if (is_moved(collider.flags))
        {
            const ColliderMotion motion = collider_motions[c];
            const Pose pose = Pose(motion.rotation_from, motion.offset_from);
            from = to_collider(pose, x - motion.origin);
            along = rotate_back(pose.rotation, way);
            moved = motion_at(motion, vec3(length(from) + length(way)));
        }
        if (!is_clear_of(collider, from, along, margin + moved))
            return false;
    }
    return true;
}

#endif
