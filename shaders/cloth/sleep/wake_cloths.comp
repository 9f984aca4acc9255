#version 460
#extension GL_GOOGLE_include_directive : require
// Writes which cloths sleep in the step. One thread per patch.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };

layout(push_constant, std430) uniform Push { SleepPush push; };

#include "sleep/sleep.glsl"

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= push.patches)
        return;
    const Patch self = patches[index];
    const bool asleep = is_asleep(self.cloth);
    patches[index].tile = (self.tile & ~VOILE_PATCH_ASLEEP) | (asleep ? VOILE_PATCH_ASLEEP : 0);
    if (!is_first_patch(self))
        return;
    // What woke it may leave it slow at first. Other patches read the same with and without this.
    if (!asleep && sleeps[self.cloth].calm > VOILE_SLEEP_TIME)
        sleeps[self.cloth].calm = 0;
    cloths[self.cloth].flags = (cloths[self.cloth].flags & ~VOILE_CLOTH_ASLEEP) | (asleep ? VOILE_CLOTH_ASLEEP : 0);
}
