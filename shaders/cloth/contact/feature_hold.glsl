// Holds a displacement within a FeatureGuard.
#ifndef VOILE_FEATURE_HOLD_GLSL
#define VOILE_FEATURE_HOLD_GLSL

// `proposed`: m, the displacement that integration proposes.
bool is_safe(FeatureGuard guard, vec3 proposed, vec3 d)
{
    return dot(guard.planes[0].xyz, d) + guard.planes[0].w >= 0 && dot(guard.planes[1].xyz, d) + guard.planes[1].w >= 0 &&
           distance(d, proposed) <= guard.reach;
}

// The part of a motion relative to `carried` that is safe.
float safe_part(FeatureGuard guard, vec3 proposed, vec3 d)
{
    if (is_safe(guard, proposed, d))
        return 1;
    return min(1, guard.least / max(distance(d, guard.carried), 1e-30));
}

#endif
