// Feature edges and feature vertices of colliders, as the GPU reads them. Written by
// modules/cloth/src/colliders/collider_features.cpp, read by find_near_features.comp and feature_contact.comp.
#ifndef VOILE_FEATURE_LAYOUT_H
#define VOILE_FEATURE_LAYOUT_H

#include "../../shared_types.h"

// Edges of a cloth that are longer than this many times the longest edge at rest may pass features undetected.
#define VOILE_MOST_STRETCH 4
// The number of substeps from one query for near features, which makes the lists of them, to the next.
#define VOILE_FEATURE_PERIOD 16
// The number of lists of near features per vertex, of entries that one has room for, and of its words.
#define VOILE_FEATURE_LISTS 2
#define VOILE_FEATURE_ENTRIES 24
#define VOILE_FEATURE_WORDS (VOILE_FEATURE_ENTRIES + 1)
// The substep of a correction that applies in no substep.
#define VOILE_NO_SUBSTEP 0xffffffffu

VOILE_SHARED_BEGIN(voile)

// A feature vertex (a == b), or a feature edge from a to b: it can protrude between the vertices of a cloth. With a
// radius it is a sphere or a capsule. In the collider's space, in the order of the leaves of the features' own
// hierarchy.
struct Feature
{
    vec3 a;
    float radius; // m
    vec3 b;
    float cosine; // of the largest angle between `normal` and a direction in which it may push; -1: any direction
    vec3 normal;  // unit, the direction that it faces
    uint padding;
};

// The features of one collider.
struct FeatureSet
{
    vec3 box_min; // m, bounds of all
    uint first_node;
    vec3 box_max;
    uint first_feature;
    uint features; // 0: there are no nodes
    float edge;    // m, the longest edge at rest of the cloths that can touch the collider
    uint padding_0;
    uint padding_1;
};

// The change that features make to the proposed state of a vertex.
struct FeatureCorrection
{
    vec3 shift;   // m
    uint substep; // in which it applies, counted over all steps
    vec3 change;  // m/s
    uint padding;
};

// Push constants of the query for near features.
struct NearFeaturesPush
{
    float time;          // s, to the next query
    float sudden;        // m/s, the speed that a vertex at rest may gain until then
    float progress_from; // 0..1, of the step, at this query
    float progress_to;   // 0..1, of the step, at the next query
    uint colliders;
    uint near_stride;
    uint first_patch;   // of the dispatch, and of its entries in the list of patches near features
    uint dispatch_word; // of the size of their dispatch
    uint vertices;      // of all cloths
};

// Push constants of feature contact.
struct FeaturePush
{
    float step;          // s
    float progress_from; // 0..1, of the step, at the substep's start
    float progress_to;   // 0..1, of the step, at the substep's end
    uint colliders;
    uint substep; // counted over all steps
    uint near_stride;
    uint first_patch; // of the entries in the list of patches near features
    uint vertices;    // of all cloths
    float progress_listed; // 0..1, of the step, when the lists of near features were made
};

VOILE_SHARED_END

#endif
