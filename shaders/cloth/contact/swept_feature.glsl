// A feature within a contact pass, of a collider that may deform.
//
// The including kernel declares features[] and what deforming_feature.glsl needs, and includes feature_pieces.glsl
// before.
#ifndef VOILE_SWEPT_FEATURE_GLSL
#define VOILE_SWEPT_FEATURE_GLSL

#include "contact/deforming_feature.glsl"

// The part of a vector across a unit vector.
vec3 tangential(vec3 v, vec3 n) { return v - dot(v, n) * n; }

struct SweptFeature
{
    Feature now;       // at the end of the pass
    vec3 moved;        // m, its a within the pass, as the collider deforms
    vec3 along_before; // m, from a to b before the pass
    vec3 facing_before; // as now.normal
};

// Of the current collider.
SweptFeature swept_feature(uint f)
{
    if (!is_deforming(collider_flags))
    {
        const Feature feature = features[f];
        return SweptFeature(feature, vec3(0), feature.b - feature.a, feature.normal);
    }
    const DeformingSet set = deforming_set(collider_index);
    const FeatureEnds before = feature_ends(set, f, push.progress_from);
    const FeatureEnds now = feature_ends(set, f, push.progress_to);
    const FeatureFacing facing = facing_at(set, f, push.progress_to);
    return SweptFeature(Feature(now.a, 0, now.b, facing.cosine, facing.normal, 0), now.a - before.a,
                        before.b - before.a, facing_at(set, f, push.progress_from).normal);
}

// m: the displacement of b.
vec3 moved_end(SweptFeature f) { return f.moved + (f.now.b - f.now.a) - f.along_before; }

// The rigid motion that takes a feature along as its collider deforms, in that collider's space.
struct FeatureMotion
{
    vec3 carried; // m, of the origin
    vec3 turned;  // of the unit quaternion whose real part is not negative
};
const FeatureMotion k_no_motion = FeatureMotion(vec3(0), vec3(0));

vec3 turned_vector(FeatureMotion motion, vec3 v)
{
    return rotate(vec4(motion.turned, sqrt(max(1 - dot(motion.turned, motion.turned), 0))), v);
}

// m: the displacement of a point.
vec3 motion_at(FeatureMotion motion, vec3 point) { return motion.carried + (turned_vector(motion, point) - point); }

vec3 a_before(SweptFeature f) { return f.now.a - f.moved; }
vec3 b_before(SweptFeature f) { return a_before(f) + f.along_before; }

// The shortest rotation from one direction to another, of any length, less than half a turn apart.
vec3 rotation_between(vec3 from, vec3 to)
{
    const float lengths = sqrt(dot(from, from) * dot(to, to));
    const float cosine = dot(from, to) / max(lengths, 1e-30);
    return cross(from, to) / max(lengths * sqrt(2 * (1 + cosine)), 1e-30);
}

// A feature turns with the direction that it faces, an edge about its new direction. More than a quarter turn within a
// pass is none.
FeatureMotion motion_of(SweptFeature f)
{
    if (!is_deforming(collider_flags))
        return k_no_motion;
    FeatureMotion motion = FeatureMotion(vec3(0), vec3(0));
    vec3 facing_before = f.facing_before;
    vec3 facing_now = f.now.normal;
    const vec3 along = f.now.b - f.now.a;
    if (along != vec3(0))
    {
        if (dot(along, f.along_before) > 0)
            motion.turned = rotation_between(f.along_before, along);
        facing_before = tangential(turned_vector(motion, facing_before), normalize(along));
        facing_now = tangential(facing_now, normalize(along));
    }
    if (dot(facing_before, facing_now) > 0)
    {
        const vec3 first = motion.turned;
        const vec3 second = rotation_between(facing_before, facing_now);
        const float first_real = sqrt(max(1 - dot(first, first), 0));
        const float second_real = sqrt(max(1 - dot(second, second), 0));
        motion.turned = first_real * second + second_real * first + cross(second, first);
    }
    motion.carried = f.moved - (turned_vector(motion, a_before(f)) - a_before(f));
    return motion;
}

#endif
