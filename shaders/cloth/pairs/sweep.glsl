// Sweeps: the segments along which the lists of pairs expect vertices to move.
//
// The including kernel declares positions[] and velocities[], and includes pairs/fan.glsl.
#ifndef VOILE_SWEEP_GLSL
#define VOILE_SWEEP_GLSL

#include "contact/rounding.glsl"
#include "shared/box.glsl"

vec3 sweep_of(uint i)
{
    const vec3 v = velocities[i].xyz;
    return v * min(push.sweep_time, push.longest_sweep / max(length(v), 1e-30));
}

// Around a vertex and its sweep.
Box sweep_box(uint i)
{
    const vec3 x = positions[i].xyz;
    return box_around(x, x + sweep_of(i));
}

// Around the primitives that a vertex owns, rounding included.
Box fan_box(Fan fan)
{
    Box box = sweep_box(fan.center);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        if (wedge.triangle || wedge.edge_b)
            box = joined(box, sweep_box(wedge.b));
        if (wedge.triangle || wedge.edge_c)
            box = joined(box, sweep_box(wedge.c));
    }
    return grown(box, rounding(box.min) + rounding(box.max));
}

#endif
