// Guards: what a vertex may do between two passes over the pairs.
#ifndef VOILE_GUARD_GLSL
#define VOILE_GUARD_GLSL

#include "shared/fine_position.glsl"

const float k_unbounded = 1e30;

// m: with length(d) <= this, a displacement d that satisfies plane q satisfies plane p, too. Both have s >= 0.
float implied_within(vec4 p, vec4 q)
{
    const float c = dot(p.xyz, q.xyz);
    const float rest = p.w - c * q.w;
    return c > 0 && rest > p.w * 1e-3 ? max(p.w, rest * inversesqrt(max(1 - c * c, 1e-8))) : p.w;
}

float implied_within(vec4 p, vec4 q, vec4 r) { return max(implied_within(p, q), implied_within(p, r)); }

// The part of a plane's distance that another one keeps in its place, so that it implies it farther away.
const float k_tighter = 0.8;

// Plane p becomes a ball in which q or r imply it. A vertex that goes farther than that, `wanted`, would be held also where
// it goes away from all planes: then the one that is more parallel to p becomes tighter.
float replaced_by(vec4 p, inout vec4 q, inout vec4 r, float wanted)
{
    const float reach = implied_within(p, q, r);
    if (reach >= wanted)
        return reach;
    const float nearer = k_tighter * p.w;
    if (dot(p.xyz, q.xyz) > dot(p.xyz, r.xyz))
        q.w = min(q.w, nearer);
    else
        r.w = min(r.w, nearer);
    return implied_within(p, q, r);
}

// Adds a plane. Of three, the one that the others imply within the largest ball becomes that ball.
void add_plane(inout PairGuard guard, vec4 plane, float wanted)
{
    vec4 a = guard.planes[0];
    vec4 b = guard.planes[1];
    const float without_a = implied_within(a, b, plane);
    const float without_b = implied_within(b, a, plane);
    const float without_new = implied_within(plane, a, b);
    float reach;
    if (without_new >= without_a && without_new >= without_b)
        reach = replaced_by(plane, a, b, wanted);
    else if (without_a >= without_b)
    {
        reach = replaced_by(a, b, plane, wanted);
        a = plane;
    }
    else
    {
        reach = replaced_by(b, a, plane, wanted);
        b = plane;
    }
    guard.reach = min(guard.reach, reach);
    guard.planes[0] = a;
    guard.planes[1] = b;
}

PairGuard no_guard()
{
    PairGuard guard;
    guard.planes[0] = guard.planes[1] = vec4(0, 0, 0, k_unbounded);
    guard.reach = k_unbounded;
    guard.from = vec3(0);
    guard.residual = uvec2(0);
    guard.support = guard.padding = 0;
    return guard;
}

#endif
