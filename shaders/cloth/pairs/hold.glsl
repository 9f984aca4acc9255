// Holds vertices within the guards of their pairs (pair_layout.h).
//
// The including kernel declares pair_bounds[].
#ifndef VOILE_HOLD_GLSL
#define VOILE_HOLD_GLSL

#include "contact/contact_vertex.glsl"
#include "pairs/guard.glsl"

// Rounding that guards leave room for, as a part of lengths.
const float k_guard_rounding = 1e-5;

// New lists are made before a vertex has used this part of its reach.
const float k_used_reach = 0.8;

// A vertex within its guards, and where they end.
struct Hold
{
    PairBound bound;
    vec3 at; // m, the start of the substep from the guard's
    vec3 swept; // m, the start of the substep from the sweep's
};

Hold hold_of(uint i, FinePosition from)
{
    Hold hold;
    const PairSweep sweep = pair_bounds[i].sweep;
    hold.bound.sweep = sweep;
    hold.bound.guard = no_guard();
    hold.bound.impulse = vec3(0);
    if (sweep.listed != 0)
    {
        hold.bound.guard = pair_bounds[i].guard;
        hold.bound.impulse = pair_bounds[i].impulse;
    }
    const PairGuard guard = hold.bound.guard;
    hold.at = displacement(FinePosition(guard.from, unpack_residual(guard.residual)), from);
    hold.swept = displacement(FinePosition(sweep.from, unpack_residual(sweep.residual)), from);
    return hold;
}

// Slides along the planes, before colliders stop the vertex.
vec3 along_planes(Hold hold, vec3 motion)
{
    for (uint k = 0; k < 4; ++k)
    {
        const vec4 plane = hold.bound.guard.planes[k & 1u];
        motion -= min(dot(plane.xyz, hold.at + motion) + plane.w * (1 - k_guard_rounding), 0) * plane.xyz;
    }
    return motion;
}

// m^2, from the segment from 0 to `sweep`
float squared_distance_from_sweep(vec3 x, vec3 sweep)
{
    const vec3 apart = x - clamp(dot(x, sweep) / max(dot(sweep, sweep), 1e-30), 0, 1) * sweep;
    return dot(apart, apart);
}

// Whether the vertex will leave what the lists leave it before they can be made again.
bool wants_lists(Hold hold, vec3 motion)
{
    const float most = k_used_reach * hold.bound.sweep.reach;
    return squared_distance_from_sweep(hold.swept + (1 + push.pair_ahead) * motion, hold.bound.sweep.sweep) >= most * most;
}

bool is_held(Hold hold, vec3 motion)
{
    const vec3 d = hold.at + motion;
    const vec3 x = hold.swept + motion;
    const float part = 1 - k_guard_rounding;
    return dot(d, hold.bound.guard.planes[0].xyz) + hold.bound.guard.planes[0].w >= 0 &&
           dot(d, hold.bound.guard.planes[1].xyz) + hold.bound.guard.planes[1].w >= 0 &&
           length(d) <= part * hold.bound.guard.reach &&
           squared_distance_from_sweep(x, hold.bound.sweep.sweep) <= part * hold.bound.sweep.reach * part * hold.bound.sweep.reach;
}

// The part of a motion after which the vertex is still within its guards. The guards are convex, and the start of the
// motion is within them, so bisection finds the end. A vertex that something else put outside is not held.
float held_part(Hold hold, vec3 motion)
{
    if (is_held(hold, motion) || !is_held(hold, vec3(0)))
        return 1;
    float low = 0;
    float high = 1;
    for (uint k = 0; k < 12; ++k)
    {
        const float middle = 0.5 * (low + high);
        if (is_held(hold, middle * motion))
            low = middle;
        else
            high = middle;
    }
    return low;
}

#endif
