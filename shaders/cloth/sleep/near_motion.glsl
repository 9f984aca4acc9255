// Whether a collider that moves or deforms in the step may touch a cloth that may sleep.
//
// The including kernel declares cloths[], sleeps[], colliders[], collider_motions[], padded_boxes[], push (SleepPush) and
// a constant COLLIDERS_MOVE of 1.
#ifndef VOILE_NEAR_MOTION_GLSL
#define VOILE_NEAR_MOTION_GLSL

#include "colliders/swept_box.glsl"
#include "shared/ordered.glsl"
#include "sleep/sleep.glsl"

const float k_wake_room = 2; // in thicknesses: the least distance of a collider that moves from a cloth that sleeps

Box sleeping_box(uint cloth)
{
    Box box;
    for (uint axis = 0; axis < 3; ++axis)
    {
        box.min[axis] = from_ordered(~sleeps[cloth].low[axis]);
        box.max[axis] = from_ordered(sleeps[cloth].high[axis]);
    }
    const float farthest = length(max(abs(box.min), abs(box.max)));
    return grown(box, k_wake_room * cloths[cloth].thickness + k_near_rounding * farthest);
}

bool moves(uint c, uint flags)
{
    if (!is_moved(flags) && !is_deforming(flags))
        return false;
    const ColliderMotion motion = collider_motions[c];
    const bool deforms = is_deforming(flags) && motion.first_from != motion.first_to;
    return deforms || motion.rotation_from != motion.rotation_to || motion.offset_from != motion.offset_to;
}

bool is_near_motion(uint cloth)
{
    const Box box = sleeping_box(cloth);
    for (uint c = 0; c < push.colliders; ++c)
    {
        const ColliderRecord collider = colliders[c];
        if ((collider.layers & cloths[cloth].layers) == 0 || !moves(c, collider.flags))
            continue;
        if (collider.kind == VOILE_COLLIDER_PLANE || overlap(swept_box(c, collider), box))
            return true;
    }
    return false;
}

#endif
