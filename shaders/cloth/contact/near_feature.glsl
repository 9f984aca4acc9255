// A feature of any collider when near features are listed.
//
// The including kernel declares features[], deforming_reach[], push (NearFeaturesPush) and what deforming_feature.glsl
// needs, and includes step_input.glsl before.
#ifndef VOILE_NEAR_FEATURE_GLSL
#define VOILE_NEAR_FEATURE_GLSL

#include "contact/deforming_feature.glsl"

// m: how far a vertex at rest may get until the next query.
float sudden_reach()
{
    const float deformed = uintBitsToFloat(deforming_reach[0]) * (push.progress_to - push.progress_from);
    return step_input.sudden * seconds(push.substeps) + deformed;
}

// A feature at the query, and how it moves until the next one, in its collider's space.
struct NearFeature
{
    vec4 a; // with its radius
    vec3 b;
    vec3 motion_a; // m
    vec3 motion_b;
};

NearFeature near_feature(uint c, uint f, bool deforms)
{
    if (!deforms)
        return NearFeature(vec4(features[f].a, features[f].radius), features[f].b, vec3(0), vec3(0));
    const DeformingSet set = deforming_set(c);
    const FeatureEnds from = feature_ends(set, f, push.progress_from);
    const FeatureEnds to = feature_ends(set, f, push.progress_to);
    return NearFeature(vec4(from.a, 0), from.b, to.a - from.a, to.b - from.b);
}

#endif
