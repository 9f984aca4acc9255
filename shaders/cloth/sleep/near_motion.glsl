// Whether a collider that moves or deforms in the step may touch a cloth that may sleep.
//
// The including kernel declares cloths[], sleeps[], colliders[], collider_motions[], padded_boxes[], push (SleepPush) and
// a constant COLLIDERS_MOVE of 1.
#ifndef VOILE_NEAR_MOTION_GLSL
#define VOILE_NEAR_MOTION_GLSL

#include "colliders/swept_box.glsl"
#include "shared/ordered.glsl"
#include "sleep/sleep.glsl"

Box box_of(uint low[3], uint high[3])
{
    return Box(vec3(from_ordered(~low[0]), from_ordered(~low[1]), from_ordered(~low[2])),
               vec3(from_ordered(high[0]), from_ordered(high[1]), from_ordered(high[2])));
}

Box sleeping_box(uint cloth)
{
    const Box box = box_of(sleeps[cloth].low, sleeps[cloth].high);
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
