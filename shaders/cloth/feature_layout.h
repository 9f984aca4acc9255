// Corners and edges of colliders as the GPU reads them. Written by modules/cloth/src/collider_features.cpp, read by
// feature_contact.comp.
#ifndef VOILE_FEATURE_LAYOUT_H
#define VOILE_FEATURE_LAYOUT_H

#include "../shared_types.h"

VOILE_SHARED_BEGIN(cloth)

// A corner (a == b) or an edge from a to b that can stand between the vertices of a cloth; with a radius a sphere or a
// capsule. In the collider's space, in the order of the leaves of their own hierarchy.
struct Feature
{
    vec3 a;
    float radius; // m
    vec3 b;
    float cosine; // between `normal` and the direction in which it may push that differs most from it; -1: any
    vec3 normal;  // unit: where it faces
    uint padding;
};

// The features of one collider.
struct FeatureSet
{
    vec3 box_min; // m, around all
    uint first_node;
    vec3 box_max;
    uint first_feature;
    uint features; // 0: none, and no nodes
    float edge;    // m, the longest of the cloths that meet the collider, at rest
    uint padding_0;
    uint padding_1;
};

// Push constants of the pass over features.
struct FeaturePush
{
    float step;          // s
    float progress_from; // 0..1, of the step at the substep's start
    float progress_to;   // and at its end
    uint colliders;
};

VOILE_SHARED_END

#endif
