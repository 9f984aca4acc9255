#version 460
#extension GL_GOOGLE_include_directive : require
// Wakes cloths that a collider may touch in this step, and writes which cloths sleep in it. One thread per patch.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) readonly buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };

layout(push_constant, std430) uniform Push { SleepPush push; };

#include "sleep/near_motion.glsl"

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.patches)
        return;
    const Patch self = patches[index];
    // The same for all patches of the cloth: no thread writes what others read.
    const bool asleep = is_asleep(self.cloth) && !is_near_motion(self.cloth);
    patches[index].tile_shift = (self.tile_shift & ~VOILE_PATCH_ASLEEP) | (asleep ? VOILE_PATCH_ASLEEP : 0);
    if (self.first == 0 && self.row == 0)
        cloths[self.cloth].flags = (cloths[self.cloth].flags & ~VOILE_CLOTH_ASLEEP) | (asleep ? VOILE_CLOTH_ASLEEP : 0);
}
