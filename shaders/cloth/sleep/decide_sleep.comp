#version 460
#extension GL_GOOGLE_include_directive : require
// How long each cloth has been calm, and which islands are restless, at the end of a step. One thread per patch; that of
// a cloth's first patch works.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pair_islands)) readonly buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { SleepPush push; };

#include "pairs/island.glsl"
#include "shared/step_input.glsl"
#include "sleep/near_motion.glsl"

// Gusts push it in every step.
bool is_gusty(uint cloth)
{
    const float quadratic = step_input.air_density * max(cloths[cloth].drag_normal, cloths[cloth].drag_tangential);
    return step_input.gust_speed > 0 && max(cloths[cloth].linear_drag, quadratic) > 0;
}

float calm_of(uint cloth)
{
    const float limit = cloths[cloth].sleep_speed;
    const bool slow = uintBitsToFloat(sleeps[cloth].speed) <= limit; // false for NaN
    if (limit == 0 || !slow || is_gusty(cloth))
        return 0;
    const float before = sleeps[cloth].calm;
    const float calm = min(before + 1 / step_input.rate, max(VOILE_SLEEP_TIME, before));
    return is_near_motion(cloth) ? 0 : calm;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.patches || !is_first_patch(patches[index]))
        return;
    const uint cloth = patches[index].cloth;
    const bool collides = (cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) != 0;
    const uint island = collides && push.cloths > 0 ? island_of(cloth) : cloth;
    const float calm = calm_of(cloth);
    sleeps[cloth].calm = calm;
    sleeps[cloth].speed = 0;
    sleeps[cloth].island = island;
    for (uint axis = 0; axis < 3; ++axis)
        sleeps[cloth].reach_low[axis] = sleeps[cloth].reach_high[axis] = 0;
    if (is_long(calm))
        return;
    atomicOr(sleeps[island].restless, 1);
    for (uint axis = 0; axis < 3; ++axis)
        sleeps[cloth].low[axis] = sleeps[cloth].high[axis] = 0;
}
