// The box that a collider sweeps in the step.
//
// The including kernel declares colliders[], collider_motions[], padded_boxes[] and a constant COLLIDERS_MOVE.
#ifndef VOILE_SWEPT_BOX_GLSL
#define VOILE_SWEPT_BOX_GLSL

#include "shared/box.glsl"
#include "colliders/collider_pose.glsl"

// Relative rounding of coordinates.
const float k_near_rounding = 2e-6;

// Of any collider but a plane, in its own space.
Box local_box(ColliderRecord collider)
{
    if (collider.kind == VOILE_COLLIDER_SPHERE)
        return Box(-collider.shape.www, collider.shape.www);
    if (collider.kind == VOILE_COLLIDER_CAPSULE)
        return Box(-abs(collider.shape.xyz) - collider.shape.w, abs(collider.shape.xyz) + collider.shape.w);
    if (collider.kind == VOILE_COLLIDER_BOX)
        return Box(-collider.shape.xyz, collider.shape.xyz);
    if (!is_deforming(collider.flags))
        return Box(collider.box_min, collider.box_max);
    return Box(padded_boxes[collider.first_node].min, padded_boxes[collider.first_node].max);
}

// Of any collider but a plane, in the world.
Box swept_box(uint c, ColliderRecord collider)
{
    const Box local = local_box(collider);
    if (!is_moved(collider.flags))
        return shifted(local, collider.origin);
    const ColliderMotion motion = collider_motions[c];
    const float radius = length(max(abs(local.min), abs(local.max)));
    return grown(shifted(box_around(motion.offset_from, motion.offset_to), motion.origin), radius);
}

#endif
