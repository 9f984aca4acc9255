#version 460
#extension GL_GOOGLE_include_directive : require
// Which islands wake at the beginning of a step: those of cloths that a collider or another cloth may touch in it, and of
// cloths that the host woke. One thread per patch; that of a cloth's first patch works.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };

layout(push_constant, std430) uniform Push { SleepPush push; };

#include "sleep/near_motion.glsl"

// Whether a cloth that is awake may come near one that may sleep.
bool is_near_cloth(uint cloth)
{
    if ((cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) == 0)
        return false;
    const Box box = sleeping_box(cloth);
    for (uint other = 0; other < push.cloths; ++other)
    {
        const bool reaches = sleeps[other].reach_high[0] != 0 && other != cloth;
        if (reaches && (cloths[other].layers & cloths[cloth].layers) != 0 &&
            overlap(box_of(sleeps[other].reach_low, sleeps[other].reach_high), box))
            return true;
    }
    return false;
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.patches || !is_first_patch(patches[index]))
        return;
    const uint cloth = patches[index].cloth;
    if (!is_long(sleeps[cloth].calm) || is_near_motion(cloth) || is_near_cloth(cloth))
        atomicOr(sleeps[island_of_sleep(cloth)].restless, 1);
}
