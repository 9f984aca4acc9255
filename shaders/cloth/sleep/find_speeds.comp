#version 460
#extension GL_GOOGLE_include_directive : require
// How fast the fastest vertex of each cloth was in the step, and where the cloth is. One thread per vertex.
//
// Contact, depenetration and the strain limit move vertices without giving them a velocity. So the displacement in the
// step counts, too.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/sleep_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(sleeps)) buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(residuals)) readonly buffer Residuals { uvec2 residuals[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(step_start_positions)) readonly buffer StepStartPositions { vec4 step_start[]; };
layout(VOILE_BINDING(step_start_residuals)) readonly buffer StepStartResiduals { uvec2 step_start_residuals[]; };

layout(push_constant, std430) uniform Push { SpeedsPush push; };

#include "shared/fine_position.glsl"
#include "shared/patch.glsl"
#include "shared/step_input.glsl"
#include "sleep/bounds.glsl"
#include "sleep/sleep.glsl"

shared uint shared_speed;

// m/s: what lies on other cloth reports up to this speed, though it rests. A pass over pairs takes back what gravity adds
// until the next one, so that velocities are half of it too low before a pass, and too high after it.
float resting_speed(uint cloth)
{
    if ((cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) == 0)
        return 0;
    return 0.5 * cloths[cloth].gravity_scale * length(step_input.gravity) * seconds(push.pass_substeps);
}

// m/s; of a vertex without mass 0
float speed_of(uint i, uint cloth)
{
    const vec4 x = positions[i];
    if (x.w == 0)
        return 0;
    const FinePosition from = FinePosition(step_start[i].xyz, unpack_residual(step_start_residuals[i]));
    const FinePosition to = FinePosition(x.xyz, unpack_residual(residuals[i]));
    return max(length(velocities[i].xyz) - resting_speed(cloth), step_input.rate * length(displacement(from, to)));
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    const uint thread = gl_LocalInvocationID.x;
    if (thread == 0 && self.local == 0)
        sleeps[self.cloth].restless = 0; // decide_sleep.comp sets it again
    if (self.asleep || cloths[self.cloth].sleep_speed == 0)
        return;
    clear_bounds(thread);
    if (thread == 0)
        shared_speed = 0;
    barrier();
    if (self.exists)
    {
        atomicMax(shared_speed, floatBitsToUint(speed_of(self.index, self.cloth))); // NaN is the largest
        add_to_bounds(Box(positions[self.index].xyz, positions[self.index].xyz));
    }
    barrier();
    if (thread == 0)
        atomicMax(sleeps[self.cloth].speed, shared_speed);
    if (thread < 3)
    {
        atomicMax(sleeps[self.cloth].low[thread], shared_low[thread]);
        atomicMax(sleeps[self.cloth].high[thread], shared_high[thread]);
    }
}
