#version 460
#extension GL_GOOGLE_include_directive : require
// Decides how much of the strain limit's changes each cloth keeps. The workgroup of a cloth's first patch adds up the
// sums of its patches. The other workgroups do nothing.
//
// Velocities keep the part that leaves the least kinetic energy. Positions keep what is paid for: by the kinetic energy
// that is removed, by what damping and contact have dissipated in this step, and by a reserve. The kinetic energy
// brings back a cloth that has fallen beyond its limit within the step. The dissipated energy keeps a cloth from
// creeping beyond it. It counts only as far as the limit undoes the step, or a limit that cannot be satisfied would
// shake the cloth with all that damping dissipates. The reserve is the energy that the limit has removed in the last
// steps: its passes are no exact projection, and return some of it.
//
// The cost of a part of the displacements is estimated from the slope at their start and from the cost of all of them,
// as if springs were linear. They are not. So the part that is kept is measured, reduced where it costs too much, and
// measured again. In the last measurement a small excess is reduced by the estimate; with a larger one nothing is kept.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(step_works_first)) readonly buffer StepWorksFirst { LimitWork step_works_first[]; };
layout(VOILE_BINDING(step_works_last)) readonly buffer StepWorksLast { LimitWork step_works_last[]; };
layout(VOILE_BINDING(limit_works_before)) readonly buffer LimitWorksBefore { LimitWork works_before[]; };
layout(VOILE_BINDING(limit_works_after)) readonly buffer LimitWorksAfter { LimitWork works_after[]; };
layout(VOILE_BINDING(limit_scales)) buffer LimitScales { LimitScale scales[]; };

layout(push_constant, std430) uniform Push { LimitScalePush push; };

#include "shared/step_input.glsl"

const float k_reserve_decay = 0.9; // of the reserve, per step
// A limit whose displacements are at most this many times the step's own, at the same vertices, undoes the step.
const float k_undoing = 5;
const float k_overdraft = 1.001; // the largest cost over the available energy; the reserve owes the rest
// A cost in the last measurement up to this many times the available energy is reduced by the estimate.
const float k_near = 1.1;

struct Energies
{
    float dissipated; // J, in the step before the limit
    float slope; // J, derivative of the cost by the fraction of the displacements that is kept, at 0
    float cost;  // J, of the displacements as they are now
    float v_dv;  // this and the following: of the limit, see LimitWork
    float dv_dv;
    float v_dx;
    float dx_dx;
    float dv_dx;
    float undone;
};

shared Energies sums[gl_WorkGroupSize.x];

Energies add(Energies a, Energies b)
{
    return Energies(a.dissipated + b.dissipated, a.slope + b.slope, a.cost + b.cost, a.v_dv + b.v_dv, a.dv_dv + b.dv_dv,
                    a.v_dx + b.v_dx, a.dx_dx + b.dx_dx, a.dv_dx + b.dv_dx, a.undone + b.undone);
}

// J: the energy that displacements from one state to the other add. `fraction`: of the displacements in the work of
// the first.
float stored(LimitWork from, LimitWork to, float fraction)
{
    return to.energy - from.energy - 0.5 * (fraction * from.linear_work + to.linear_work);
}

// `fraction`: of the limit's displacements, as they are now.
Energies energies_of(uint patch_index, float fraction)
{
    const LimitWork first = step_works_first[patch_index];
    const LimitWork last = step_works_last[patch_index];
    const LimitWork before = works_before[patch_index];
    const LimitWork after = works_after[patch_index];
    return Energies(-stored(first, last, 1) - first.v_dv - 0.5 * first.dv_dv, -before.work, stored(before, after, fraction),
                    before.v_dv, before.dv_dv, before.v_dx, before.dx_dx, before.dv_dx, before.undone);
}

// The x between 0 and `most` for which a x + 1/2 b x^2 is least.
float least(float a, float b, float most) { return b > 0 ? clamp(-a / b, 0, most) : 0; }

// The fraction of displacements that costs no more than `available`, from the slope of the cost at 0 and the cost of
// all.
float affordable(float slope, float cost, float available)
{
    if (cost <= available)
        return 1;
    const float curvature = max(cost - slope, 1e-6 * abs(slope));
    return clamp((sqrt(slope * slope + 4 * curvature * available) - slope) / (2 * curvature), 0, 1);
}

LimitScale scale_of(float reserve, Energies e)
{
    // v dv + shift dx with the least kinetic energy, by alternating minimization.
    float v = 1;
    float shift = 0;
    for (int i = 0; i < 8; ++i)
    {
        v = least(e.v_dv + shift * e.dv_dx, e.dv_dv, 1);
        shift = least(e.v_dx + v * e.dv_dx, e.dx_dx, step_input.rate);
    }
    const float kinetic = v * e.v_dv + shift * e.v_dx + v * shift * e.dv_dx + 0.5 * (v * v * e.dv_dv + shift * shift * e.dx_dx);
    const float remaining = reserve - kinetic;
    const float undone = e.dx_dx > 0 ? clamp(k_undoing * e.undone / e.dx_dx, 0, 1) : 1;
    const float dissipated = undone * max(e.dissipated, 0);
    const float x = affordable(e.slope, e.cost, max(remaining + dissipated, 0));
    const float sum = x + v + shift + remaining + dissipated;
    return isnan(sum) || isinf(sum) ? LimitScale(0, 0, 0, 0, 0, 0) : LimitScale(x, v, shift, x, remaining, dissipated);
}

// The second and later measurements, of the displacements that are kept. Velocities are final.
LimitScale rescaled(LimitScale s, Energies e)
{
    const bool last = push.measurement == VOILE_LIMIT_MEASUREMENTS;
    const float available = max(s.reserve + s.dissipated, 0);
    float x = 1;
    if (!(e.cost <= k_overdraft * available))
        x = last && !(e.cost <= k_near * available) ? 0 : affordable(e.slope * s.fraction, e.cost, available);
    x = isnan(x) ? 0 : x;
    float reserve = s.reserve;
    if (last)
    {
        const float cost = x * e.cost;
        reserve -= cost > 0 ? max(cost - s.dissipated, 0) : cost;
        reserve *= reserve > 0 ? k_reserve_decay : 1;
    }
    return LimitScale(x, 1, 0, x * s.fraction, isnan(reserve) || isinf(reserve) ? 0 : reserve, s.dissipated);
}

void main()
{
    const uint first = gl_WorkGroupID.x;
    const uint cloth = patches[first].cloth;
    const bool asleep = (patches[first].tile & VOILE_PATCH_ASLEEP) != 0;
    if (asleep || (first > 0 && patches[first - 1].cloth == cloth))
        return;
    const uint thread = gl_LocalInvocationID.x;
    const LimitScale scale = scales[cloth];
    const float fraction = push.measurement == 0 ? 1 : scale.fraction;
    Energies sum = Energies(0, 0, 0, 0, 0, 0, 0, 0, 0);
    for (uint c = first + thread; c < push.patches && patches[c].cloth == cloth; c += gl_WorkGroupSize.x)
        sum = add(sum, energies_of(c, fraction));
    sums[thread] = sum;
    barrier();
    for (uint half_size = gl_WorkGroupSize.x / 2; half_size > 0; half_size /= 2)
    {
        if (thread < half_size)
            sums[thread] = add(sums[thread], sums[thread + half_size]);
        barrier();
    }
    if (thread == 0)
        scales[cloth] = push.measurement == 0 ? scale_of(scale.reserve, sums[0]) : rescaled(scale, sums[0]);
}
