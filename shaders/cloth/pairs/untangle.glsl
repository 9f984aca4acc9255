// Moves vertices of cloth that intersects out of it (find_tangles.comp).
//
// The including kernel declares pair_searches[] and tangles[].
#ifndef VOILE_UNTANGLE_GLSL
#define VOILE_UNTANGLE_GLSL

#include "contact/contact_vertex.glsl"

// m/s, up to which such a vertex is accelerated, and m/s^2. It could fold cloth, but hardly stretches it.
const float k_untangle_speed = 0.5;
const float k_untangle_acceleration = 300;
// Where the directions of a vertex' pairs add up to less than this part of their number, it is slower: along a straight
// line of intersection they cancel out, and what is left is rounding.
const float k_whole_direction = 0.2;

// m/s, towards which a vertex that has mass is accelerated.
vec3 untangling_velocity(Tangle tangle)
{
    const vec3 sum = VOILE_TANGLE_UNIT * vec3(tangle.direction[0], tangle.direction[1], tangle.direction[2]);
    const float whole = k_whole_direction * float(tangle.pairs);
    return k_untangle_speed * sum / max(length(sum), whole);
}

// Whether the motion changes. Loaded only in steps in which cloth intersects.
bool untangle(uint i, inout Motion motion)
{
    if (pair_searches[VOILE_PAIR_TANGLED].entries == 0 || push.substeps == 0)
        return false;
    const Tangle tangle = tangles[i];
    if (tangle.pairs == 0)
        return false;
    const vec3 wanted = untangling_velocity(tangle);
    const float speed = length(wanted);
    if (speed == 0)
        return false;
    const vec3 n = wanted / speed;
    const float duration = seconds(push.substeps);
    const float change = clamp(speed - dot(motion.v, n), 0, k_untangle_acceleration * duration);
    motion.v += change * n;
    motion.displacement += duration * change * n;
    return change > 0;
}

#endif
