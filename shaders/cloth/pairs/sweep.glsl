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

// Adds the middle of a vertex's sweep. `reach`: m, half of the longest sweep.
void add_sweep(uint i, inout Box box, inout float reach)
{
    const vec3 sweep = sweep_of(i);
    const vec3 middle = positions[i].xyz + 0.5 * sweep;
    box = joined(box, Box(middle, middle));
    reach = max(reach, 0.5 * length(sweep));
}

// Around the primitives that a vertex owns, rounding included. Distances of pairs leave room for half of the longest
// sweep of a primitive in all directions (find_pairs.comp), so that both sides of a pair find it only if boxes do, too.
Box fan_box(Fan fan)
{
    Box box = Box(vec3(1e30), vec3(-1e30)); // empty
    float reach = 0;
    add_sweep(fan.center, box, reach);
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        if (wedge.triangle || wedge.edge_b)
            add_sweep(wedge.b, box, reach);
        if (wedge.triangle || wedge.edge_c)
            add_sweep(wedge.c, box, reach);
    }
    return grown(box, reach + rounding(box.min) + rounding(box.max));
}

#endif
