// The motion of a vertex within its guard (FeatureGuard).
#ifndef VOILE_FEATURE_HOLD_GLSL
#define VOILE_FEATURE_HOLD_GLSL

// Each plane may push the vertex beyond another one, so they are answered in turn, so often.
const uint k_hold_rounds = 2;

// m: how far inside a plane a displacement is.
float inside(vec4 plane, vec3 d)
{
    return dot(plane.xyz, d) + plane.w;
}

// The part of the motion from `carried` to d that is inside of a half-space.
float part_inside(vec4 plane, vec3 carried, vec3 d)
{
    const float end = inside(plane, d);
    const float start = max(inside(plane, carried), 0);
    return end >= 0 ? 1 : start / (start - end);
}

// Whether a displacement is inside of all half-spaces that are not kept. Each of them contains the ball of `least` around
// `carried` and the one of `reach` around `proposed`, so it contains those whose radii are between both, in between.
bool is_within_reach(FeatureGuard guard, vec3 proposed, vec3 d)
{
    const vec3 apart = d - guard.carried;
    const vec3 axis = proposed - guard.carried;
    const float growth = guard.reach - guard.least;
    const float squared = max(dot(axis, axis), 1e-30);
    const float along = dot(apart, axis);
    // The ball that reaches farthest beyond d touches the cone of all of them where its radius to d is normal to the cone.
    const float across = sqrt(max(dot(apart, apart) * squared - along * along, 0));
    const float lean = growth * across * inversesqrt(max(squared - growth * growth, 1e-30));
    const float at = clamp((along + lean) / squared, 0, 1);
    return distance(apart, at * axis) <= guard.least + at * growth;
}

// The part of a motion relative to `carried` that is safe. `proposed`: m, the displacement that integration proposes. What
// planes do to that stays in the ball whose diameter goes from `carried` to it, where all features are known
// (held_box). What contact does beyond it may be as long as the thickness.
float safe_part(FeatureGuard guard, vec3 proposed, vec3 d, float thickness)
{
    float part = 1;
    for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        part = min(part, part_inside(guard.planes[k], guard.carried, d));
    const vec3 apart = d - guard.carried;
    const vec3 radius = 0.5 * (proposed - guard.carried);
    float least = is_within_reach(guard, proposed, d) ? 3e38 : guard.least;
    if (distance(apart, radius) > length(radius) + thickness)
        least = min(least, thickness);
    return min(part, least / max(length(apart), 1e-30));
}

struct HeldMotion
{
    vec3 displacement; // m
    vec3 velocity;     // m/s
};

// Cuts a motion where its guard ends. `proposed`: m, the displacement that integration proposes; `duration`: s, of the
// motion.
HeldMotion cut(FeatureGuard guard, vec3 proposed, HeldMotion motion, float thickness, float duration)
{
    const float part = safe_part(guard, proposed, motion.displacement, thickness);
    return HeldMotion(mix(guard.carried, motion.displacement, part), mix(guard.carried / duration, motion.velocity, part));
}

// Holds a motion within its guard: it slides along planes before it is cut.
HeldMotion hold(FeatureGuard guard, vec3 proposed, HeldMotion motion, float thickness, float duration)
{
    const vec3 carry = guard.carried / duration;
    for (uint round = 0; round < k_hold_rounds; ++round)
        for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        {
            const vec4 plane = guard.planes[k];
            const float outside = max(-inside(plane, motion.displacement), 0);
            motion.displacement += outside * plane.xyz;
            if (outside > 0)
                motion.velocity -= min(dot(plane.xyz, motion.velocity - carry), 0) * plane.xyz;
        }
    return cut(guard, proposed, motion, thickness, duration);
}

#endif
