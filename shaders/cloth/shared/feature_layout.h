// Corners and edges of colliders as the GPU reads them. Written by modules/cloth/src/collider_features.cpp, read by
// find_near_features.comp and feature_contact.comp.
#ifndef VOILE_FEATURE_LAYOUT_H
#define VOILE_FEATURE_LAYOUT_H

#include "../../shared_types.h"

// Edges of a cloth longer than so many times the longest one at rest may pass unseen.
#define VOILE_MOST_STRETCH 4
// How many substeps lie between two looks at which patches come near features.
#define VOILE_FEATURE_PERIOD 16
// The stamp of a correction that holds in no substep.
#define VOILE_NO_SUBSTEP 0xffffffffu

VOILE_SHARED_BEGIN(voile)

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

// What features change of a vertex that integration proposes.
struct FeatureCorrection
{
    vec3 shift;   // m
    uint substep; // in which it holds, counted through all steps
    vec3 change;  // m/s
    uint padding;
};

// Push constants of the look at which patches are near.
struct NearFeaturesPush
{
    float time;          // s, to the next look
    float sudden;        // m/s, that a vertex at rest may come to have until then
    float progress_from; // 0..1, of the step at its start
    float progress_to;   // and at its end
    uint colliders;
    uint near_stride;
};

// Push constants of the pass over features.
struct FeaturePush
{
    float step;          // s
    float progress_from; // 0..1, of the step at the substep's start
    float progress_to;   // and at its end
    uint colliders;
    uint substep; // counted through all steps
    uint near_stride;
};

VOILE_SHARED_END

#endif
