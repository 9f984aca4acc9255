// Guards: what a vertex may do between two passes over the pairs.
#ifndef VOILE_GUARD_GLSL
#define VOILE_GUARD_GLSL

#include "shared/fine_position.glsl"

const float k_unbounded = 1e30;

// Where colliders push crowded cloth, planes are kept tighter than they are, by this part: else planes that are almost parallel
// would become a ball that also holds a vertex which goes away from all of them.
const float k_tight = 0.8;

// m: with length(d) <= this, a displacement d that satisfies plane q satisfies plane p, too. Both have s >= 0. `loose`: what
// p really is, as a multiple.
float implied_within(vec4 p, vec4 q, float loose)
{
    const float c = dot(p.xyz, q.xyz);
    const float rest = loose * p.w - c * q.w;
    return c > 0 && rest > p.w * 1e-3 ? max(p.w, rest * inversesqrt(max(1 - c * c, 1e-8))) : p.w;
}

float implied_within(vec4 p, vec4 q, vec4 r, float loose)
{
    return max(implied_within(p, q, loose), implied_within(p, r, loose));
}

// Adds a plane. Of three, the one that the others imply within the largest ball becomes that ball. `loose`: 1, or 1 / k_tight
// if planes are tight.
void add_plane(inout PairGuard guard, vec4 plane, float loose)
{
    const vec4 a = guard.planes[0];
    const vec4 b = guard.planes[1];
    const float without_a = implied_within(a, b, plane, loose);
    const float without_b = implied_within(b, a, plane, loose);
    const float without_new = implied_within(plane, a, b, loose);
    if (without_new >= without_a && without_new >= without_b)
        guard.reach = min(guard.reach, without_new);
    else if (without_a >= without_b)
    {
        guard.reach = min(guard.reach, without_a);
        guard.planes[0] = plane;
    }
    else
    {
        guard.reach = min(guard.reach, without_b);
        guard.planes[1] = plane;
    }
}

PairGuard no_guard()
{
    PairGuard guard;
    guard.planes[0] = guard.planes[1] = vec4(0, 0, 0, k_unbounded);
    guard.reach = k_unbounded;
    guard.from = vec3(0);
    guard.residual = uvec2(0);
    guard.support = guard.massless = 0;
    return guard;
}

#endif
