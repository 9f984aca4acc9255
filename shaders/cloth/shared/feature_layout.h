// Feature edges and feature vertices of colliders, as the GPU reads them. Written by
// modules/cloth/src/colliders/collider_features.cpp, read by find_near_features.comp and feature_contact.comp. Those of
// meshes that deform: deforming_features.cpp and face_features.comp.
#ifndef VOILE_FEATURE_LAYOUT_H
#define VOILE_FEATURE_LAYOUT_H

#include "../../shared_types.h"

// Edges of a cloth that are longer than this many times the longest edge at rest may pass features undetected.
#define VOILE_MOST_STRETCH 4
// The mean number of items per vertex that there is room for, and the number of all vertices beyond that. The largest
// number of one vertex, and those of a second query where the items of the first are more than there is room for. Where
// that is not enough, either, all vertices get the same.
#define VOILE_FEATURE_ITEMS 8
#define VOILE_MORE_FEATURE_ITEMS 65536
#define VOILE_MOST_FEATURE_ITEMS 128
#define VOILE_FEWER_FEATURE_ITEMS 64
#define VOILE_FEWEST_FEATURE_ITEMS 24
// The kind of a piece in an item.
#define VOILE_PIECE_TRIANGLE 0
#define VOILE_PIECE_EDGE_B 1
#define VOILE_PIECE_EDGE_C 2
#define VOILE_PIECE_GUARD 3 // no feature: the item checks that the items of the vertex suffice
#define VOILE_ITEM_CLOTH_BITS 20
#define VOILE_NO_VERTEX 0xffffffffu // of an item that is none
// Of a batch: the size of the dispatch over items, and how many there would be with fewer items of a vertex; the size
// of that over patches near features, and the number of items; the size of a second query if there is no room for them,
// and the number of its items; how many there would be with the fewest of a vertex.
#define VOILE_FEATURE_DISPATCH_WORDS 13
#define VOILE_DISPATCH_FEWER 3
#define VOILE_DISPATCH_PATCHES 4
#define VOILE_DISPATCH_CLAIMED 7
#define VOILE_DISPATCH_RETRY 8
#define VOILE_DISPATCH_RETRY_CLAIMED 11
#define VOILE_DISPATCH_FEWEST 12
// Of a batch: the sizes of the dispatches for vertices whose items do not suffice, in even and in odd passes, and the
// number of patches if vertices have no items until the next query.
#define VOILE_TRAVERSAL_WORDS 7
#define VOILE_TRAVERSAL_UNLISTED 6
// What a dispatch of feature_contact.comp does. CPU devices execute both sides of branches, and loops once at least, so
// they take two dispatches: the second one is empty in most passes, and most of the code is in it. GPUs take one.
#define VOILE_FEATURES_ALL 0
#define VOILE_FEATURES_LISTED 1    // answers the items
#define VOILE_FEATURES_TRAVERSED 2 // traverses where they do not suffice
// In a slot of a deforming mesh: its first feature, and how many there are in the lowest bits.
#define VOILE_SLOT_FEATURE_BITS 3
// Instead of the cosine of a facing: the mesh is too flat there for a feature.
#define VOILE_NO_FACING 2.0f
// The substep of a correction that applies in no substep.
#define VOILE_NO_SUBSTEP 0xffffffffu
// Instead of the substep in which a vertex's items are not valid: until the next query.
#define VOILE_EVERY_SUBSTEP 0xfffffffeu

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
    float depth;  // m: cloth so far behind it has come in here; half of how far the solid goes on there. 0: unknown
};

// A feature of a mesh that deforms, in the order of the slots of its hierarchy: a vertex (a == b), or an edge. Which
// way it faces follows from the hinges around it.
struct FeatureSource
{
    uint a; // vertices of the mesh
    uint b;
    uint first_hinge;
    uint hinges;
    float reach;   // m: where features may be this far apart, another one stands for it if the mesh bends there
    uint stand_in; // that one
};

// The triangles at an edge of a mesh that deforms, (a, b, c) and (b, a, d), as vertices of the mesh.
struct FeatureHinge
{
    uint a;
    uint b;
    uint c;
    uint d; // VOILE_NO_VERTEX: a border, or an edge with more than two triangles
};

// Which way a feature of a mesh that deforms faces at one end of the step.
struct FeatureFacing
{
    vec3 normal;  // as in Feature
    float cosine; // or VOILE_NO_FACING
};

// The features of one collider.
struct FeatureSet
{
    vec3 box_min;    // m, bounds of all; not of a mesh that deforms
    uint first_node; // of a mesh that deforms: its first slot
    vec3 box_max;
    uint first_feature; // of a mesh that deforms: its first source
    uint features;      // 0: there are no nodes
    float edge;         // m, the longest edge at rest of the cloths that can touch the collider
    uint first_facing;  // of a mesh that deforms: of as many as there are features, twice
    uint padding;
};

// Push constants of the pass that finds which way the features of a deforming mesh face.
struct FaceFeaturesPush
{
    uint first_feature;
    uint features;
    uint first_vertex; // where the mesh is now
    uint first_facing; // of the result
    uint two_sided;    // 1: features push in all directions
    float edge;        // m, the longest of the cloths
    float sag;         // m, by which cloth may sink towards a bend
};

#define VOILE_GUARD_PLANES 4

// Where a vertex may move within a contact pass, so that no piece of cloth that it is in crosses a feature: within
// half-spaces of which the most urgent are kept, and bounds for the others. All displacements are from the start of the
// motion.
struct FeatureGuard
{
    vec4 planes[VOILE_GUARD_PLANES]; // unit, into the half-space, and m: the distance of the start from its border
    vec3 carried;                    // m, the displacement with the nearest feature
    float least;                     // m, from there to the border of the nearest half-space that is not kept
    float reach;                     // m, the same from what integration proposes; negative: outside
    uint padding_0;
    uint padding_1;
    uint padding_2;
};

// The change that features make to the proposed state of a vertex.
struct FeatureCorrection
{
    vec3 shift;   // m
    uint substep; // in which it applies, counted over all steps
    vec3 change;  // m/s
    uint guarded; // 1: the vertex has a guard in this substep
};

// The motion of a vertex when near features were listed.
struct FeatureCenter
{
    vec3 x;           // m
    float velocity_x; // m/s
    uvec2 residual;   // fine_position.glsl
    vec2 velocity_yz; // m/s
};

// A feature near a piece of cloth, until the next query.
struct FeatureItem
{
    uint vertex;   // that has the piece
    uint feature;  // of a guard: the margin, m, as the bits of a float
    uint collider; // the upper half: a lower bound of the distance beyond the thickness, m, as half a float
    uint piece;    // of bits: 20 for the cloth, 2 for the kind of the piece, 10 for its number
};

// The items of a vertex.
struct FeatureCell
{
    uint first;
    uint count;
    uint invalid;     // the last substep in which features may be near that are not among them
    uint guarded;     // the last substep in which an item had a plane (FeatureGuard)
    uvec4 touched[2]; // one bit per item that is in contact, for even and for odd passes
};

// The contact of a feature with a piece of cloth, or a plane that a piece of cloth may not cross.
struct FeatureResponse
{
    vec3 direction;   // unit, world
    float correction; // m, along it
    vec3 slowing;     // m/s, by friction
    float approach;   // m/s
    vec4 portions;    // of the cell's vertices in the motion of the contact point; of a mesh the first is the vertex's
    vec4 plane;       // collider's space: separates the piece from the feature before the motion; 0: none
    vec3 carried;     // the motion of the feature and of the plane as the collider deforms, FeatureMotion
    uint collider;
    vec3 turned;
    uint vertices; // of the cell that the piece has, one bit each
};

// Push constants of the query for near features. Times are in substeps of level 0.
struct NearFeaturesPush
{
    float substeps;      // to the next query
    float progress_from; // 0..1, of the step, at this query
    float progress_to;   // 0..1, of the step, at the next query
    uint colliders;
    uint near_stride;
    uint first_patch;    // of the dispatch, and of its entries in the list of patches near features
    uint dispatch_word;  // of the sizes of the dispatches
    uint lanes;          // threads per vertex
    uint first_item;     // of those that the dispatch may write
    uint items;          // their number
    uint query;          // the number of this one in the step
    uint retries;        // 1: the items of the query before are more than there is room for
    uint traversal_word; // of the sizes of the batch's traversals
};

// Push constants of feature contact. Times are in substeps of level 0.
struct FeaturePush
{
    float substeps;      // since the last contact pass
    float progress_from; // 0..1, of the step, at the last contact pass
    float progress_to;   // 0..1, of the step, at the substep's end
    uint colliders;
    uint substep; // of the step
    uint near_stride;
    uint first_patch;      // of the entries in the list of patches near features
    float progress_listed; // 0..1, of the step, when near features were listed
    float progress_next;   // 0..1, of the step, when they will be listed again
    uint first_item;       // of the dispatch over items
    uint items;            // that there is room for
    uint dispatch_word;    // of the sizes of the dispatches
    uint lanes;            // threads per vertex that traverses
    uint kicks;            // substeps since the last contact pass
    uint pass;             // counted since near features were listed
    uint traversal_word;   // of the sizes of the batch's traversals
    uint limited_only;     // 1: after the strain limit, when no time passes
};

VOILE_SHARED_END

#endif
