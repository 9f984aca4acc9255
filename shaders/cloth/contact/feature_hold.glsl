// Holds a displacement within a FeatureGuard.
#ifndef VOILE_FEATURE_HOLD_GLSL
#define VOILE_FEATURE_HOLD_GLSL

#include "shared/segments.glsl"

// m: how far inside a plane a displacement is.
float inside(vec4 plane, vec3 d)
{
    return dot(plane.xyz, d) + plane.w;
}

// `proposed`: m, the displacement that integration proposes.
bool is_safe(FeatureGuard guard, vec3 proposed, vec3 d)
{
    return min(inside(guard.planes[0], d), inside(guard.planes[1], d)) >= 0 && distance(d, proposed) <= guard.reach &&
           squared_distance_from_segment(d - guard.carried, proposed - guard.carried) <= guard.stray * guard.stray;
}

// The part of a motion relative to `carried` that is safe.
float safe_part(FeatureGuard guard, vec3 proposed, vec3 d)
{
    if (is_safe(guard, proposed, d))
        return 1;
    return min(1, min(guard.least, guard.stray) / max(distance(d, guard.carried), 1e-30));
}

#endif
