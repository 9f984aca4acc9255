#version 460
#extension GL_GOOGLE_include_directive : require
// How much of what the strain limit has changed each cloth keeps: as much as its energy bears. The sums of a cloth's patches
// are added up by the workgroup of its first one; the others have nothing to do.
//
// Velocities take what leaves them the least kinetic energy. Positions take what is paid for: by the kinetic energy that
// goes, by what damping and contact have taken in this step, and by a reserve. The first brings a cloth back that has fallen
// beyond its limit within the step. The second keeps one from creeping beyond it; it counts as far as the limit undoes the
// step, or a limit that cannot be kept would shake the cloth with all that damping takes. The reserve is what the limit has taken
// from the cloth's energy in the last steps: its passes are no exact projection, and give some of it back.
// Reads: patches, work. Writes: one scale per cloth.
#include "cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 1, std430) readonly buffer StepWorksFirst { LimitWork step_works_first[]; };
layout(set = 0, binding = 2, std430) readonly buffer StepWorksLast { LimitWork step_works_last[]; };
layout(set = 0, binding = 3, std430) readonly buffer WorksBefore { LimitWork works_before[]; };
layout(set = 0, binding = 4, std430) readonly buffer WorksAfter { LimitWork works_after[]; };
layout(set = 0, binding = 5, std430) buffer Scales { LimitScale scales[]; };

layout(push_constant, std430) uniform Push { LimitScalePush push; };

const float k_kept = 0.9; // of the reserve, per step
// A limit whose displacements are up to so many times the step's own, in the same places, undoes the step.
const float k_undoing = 5;

struct Energies
{
    float lost;    // J, in the step before the limit
    float first;   // J, that the positions cost, to the first and to the second order in what is kept of them
    float second;
    LimitWork limit;
};

shared Energies sums[gl_WorkGroupSize.x];

Energies add(Energies a, Energies b)
{
    const LimitWork l = a.limit;
    const LimitWork m = b.limit;
    return Energies(a.lost + b.lost, a.first + b.first, a.second + b.second,
                    LimitWork(0, l.v_dv + m.v_dv, l.dv_dv + m.dv_dv, l.v_dx + m.v_dx, l.dx_dx + m.dx_dx,
                              l.dv_dx + m.dv_dx, l.undone + m.undone, 0));
}

Energies energies_of(uint chunk)
{
    const LimitWork first = step_works_first[chunk];
    const LimitWork before = works_before[chunk];
    return Energies(0.5 * (first.work + step_works_last[chunk].work) - first.v_dv - 0.5 * first.dv_dv, -before.work,
                    -0.5 * (works_after[chunk].work - before.work), before);
}

// Where a x + 1/2 b x^2 is least between 0 and `most`.
float least(float a, float b, float most) { return b > 0 ? clamp(-a / b, 0, most) : 0; }

LimitScale scale_of(float reserve, Energies e)
{
    // v dv + shift dx with the least kinetic energy, one after the other in turn.
    const LimitWork l = e.limit;
    float v = 1;
    float shift = 0;
    for (int i = 0; i < 8; ++i)
    {
        v = least(l.v_dv + shift * l.dv_dx, l.dv_dv, 1);
        shift = least(l.v_dx + v * l.dv_dx, l.dx_dx, push.rate);
    }
    const float kinetic = v * l.v_dv + shift * l.v_dx + v * shift * l.dv_dx + 0.5 * (v * v * l.dv_dv + shift * shift * l.dx_dx);
    const float saved = max(reserve - kinetic, 0);
    const float undone = l.dx_dx > 0 ? clamp(k_undoing * l.undone / l.dx_dx, 0, 1) : 1;
    const float lost = undone * max(e.lost, 0);
    const float available = saved + lost;
    float x = 1;
    if (e.first + e.second > available)
    {
        const float second = max(e.second, 1e-6 * abs(e.first));
        x = clamp((sqrt(e.first * e.first + 4 * second * available) - e.first) / (2 * second), 0, 1);
    }
    const float cost = x * (e.first + x * e.second);
    const float rest = k_kept * (saved - (cost > 0 ? max(cost - lost, 0) : cost));
    const float sum = x + v + shift + rest;
    return isnan(sum) || isinf(sum) ? LimitScale(0, 0, 0, 0) : LimitScale(x, v, shift, max(rest, 0));
}

void main()
{
    const uint first = gl_WorkGroupID.x;
    const uint cloth = chunks[first].cloth;
    if (first > 0 && chunks[first - 1].cloth == cloth)
        return;
    const uint thread = gl_LocalInvocationID.x;
    Energies sum = Energies(0, 0, 0, LimitWork(0, 0, 0, 0, 0, 0, 0, 0));
    for (uint c = first + thread; c < push.chunks && chunks[c].cloth == cloth; c += gl_WorkGroupSize.x)
        sum = add(sum, energies_of(c));
    sums[thread] = sum;
    barrier();
    for (uint half_size = gl_WorkGroupSize.x / 2; half_size > 0; half_size /= 2)
    {
        if (thread < half_size)
            sums[thread] = add(sums[thread], sums[thread + half_size]);
        barrier();
    }
    if (thread == 0)
        scales[cloth] = scale_of(scales[cloth].reserve, sums[0]);
}
