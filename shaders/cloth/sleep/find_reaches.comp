#version 460
#extension GL_GOOGLE_include_directive : require
// Where each cloth that collides with others, and is awake, may come in the step: along its velocities, and by gravity.
// One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };

#include "shared/patch.glsl"
#include "shared/step_input.glsl"
#include "sleep/bounds.glsl"
#include "sleep/sleep.glsl"

Box reach_of(uint i, uint cloth)
{
    const float duration = 1 / step_input.rate;
    const vec3 x = positions[i].xyz;
    const float room = k_wake_room * cloths[cloth].pair_range + length(step_input.gravity) * duration * duration;
    return grown(box_around(x, x + duration * velocities[i].xyz), room);
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    const uint thread = gl_LocalInvocationID.x;
    const bool collides = (cloths[self.cloth].flags & VOILE_CLOTH_SELF_COLLISION) != 0;
    if (!collides || is_asleep(self.cloth)) // the cloth of all threads
        return;
    clear_bounds(thread);
    barrier();
    if (self.exists)
        add_to_bounds(reach_of(self.index, self.cloth));
    barrier();
    if (thread >= 3)
        return;
    atomicMax(sleeps[self.cloth].reach_low[thread], shared_low[thread]);
    atomicMax(sleeps[self.cloth].reach_high[thread], shared_high[thread]);
}
