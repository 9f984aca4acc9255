// Features of meshes that deform: where they are and which way they face within the step.
//
// The including kernel declares feature_sets[], feature_sources[], feature_facings[], deforming_positions[] and
// collider_motions[].
#ifndef VOILE_DEFORMING_FEATURE_GLSL
#define VOILE_DEFORMING_FEATURE_GLSL

// Of one mesh, at the step's start and at its end.
struct DeformingSet
{
    uvec2 vertices; // the first ones
    uvec2 facings;  // of its first feature
    uint first_feature;
};

DeformingSet deforming_set(uint c)
{
    const ColliderMotion motion = collider_motions[c];
    const uvec2 halves = uvec2(motion.halves & 1, motion.halves >> 1);
    return DeformingSet(uvec2(motion.first_from, motion.first_to),
                        feature_sets[c].first_facing + halves * feature_sets[c].features,
                        feature_sets[c].first_feature);
}

// m, the collider's space.
struct FeatureEnds
{
    vec3 a;
    vec3 b;
};

vec3 deformed(DeformingSet set, uint vertex, float progress)
{
    return mix(deforming_positions[set.vertices.x + vertex].xyz, deforming_positions[set.vertices.y + vertex].xyz, progress);
}

FeatureEnds feature_ends(DeformingSet set, uint feature, float progress)
{
    const FeatureSource source = feature_sources[feature];
    return FeatureEnds(deformed(set, source.a, progress), deformed(set, source.b, progress));
}

// Whether the mesh bends enough for a feature at either end of the step.
bool protrudes(DeformingSet set, uint feature)
{
    const uint i = feature - set.first_feature;
    return min(feature_facings[set.facings.x + i].cosine, feature_facings[set.facings.y + i].cosine) < VOILE_NO_FACING;
}

FeatureFacing facing_at(DeformingSet set, uint feature, float progress)
{
    const uint i = feature - set.first_feature;
    const FeatureFacing from = feature_facings[set.facings.x + i];
    const FeatureFacing to = feature_facings[set.facings.y + i];
    const vec3 normal = mix(from.normal, to.normal, progress);
    const float size = length(normal);
    if (size < 1e-3)
        return FeatureFacing(to.normal, -1);
    return FeatureFacing(normal / size, min(from.cosine, to.cosine));
}

#endif
