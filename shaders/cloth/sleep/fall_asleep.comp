#version 460
#extension GL_GOOGLE_include_directive : require
// Stops the vertices of cloths that fall asleep at the end of the step. One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(velocities)) buffer Velocities { vec4 velocities[]; };

#include "shared/patch.glsl"
#include "sleep/sleep.glsl"

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists || self.asleep || !is_asleep(self.cloth))
        return;
    velocities[self.index].xyz = vec3(0); // its contacts stay
    if (self.local == 0)
        sleeps[self.cloth].calm = VOILE_SLEEPING; // it is long for other threads before and after
}
