// Colliders, their motions, and which of them are near a patch, as the GPU reads them. Hierarchies of their meshes:
// bvh_layout.h, padded_layout.h; feature edges and vertices: feature_layout.h.
#ifndef VOILE_COLLIDER_LAYOUT_H
#define VOILE_COLLIDER_LAYOUT_H

#include "../../shared_types.h"

#define VOILE_COLLIDER_PLANE 0
#define VOILE_COLLIDER_SPHERE 1
#define VOILE_COLLIDER_MESH 2
#define VOILE_COLLIDER_CAPSULE 3
#define VOILE_COLLIDER_BOX 4

// Flags of a collider.
#define VOILE_COLLIDER_CLOSED 1u    // a mesh without a border
#define VOILE_COLLIDER_FRICTION 2u  // it has friction coefficients of its own
#define VOILE_COLLIDER_ONE_SIDED 4u // a mesh pushes to the side its triangles face; else to where a vertex came from
#define VOILE_COLLIDER_MOVED 8u     // it is, or was, somewhere else than where it was added: see its ColliderMotion
#define VOILE_COLLIDER_DEFORMS 16u  // a mesh whose vertices move: its hierarchy is a padded tree (padded_layout.h)

// The colliders near a patch (find_near_colliders.comp), in words: the box in which the list holds, where its bits begin and
// end that are not 0, in words of them, and then the bits, one per collider.
#define VOILE_NEAR_MIN 0
#define VOILE_NEAR_FIRST 3
#define VOILE_NEAR_MAX 4
#define VOILE_NEAR_END 7
#define VOILE_NEAR_WORDS 8
// How many substeps lie between two looks at which colliders are near,
#define VOILE_NEAR_PERIOD 16
// and how many colliders there are at most without.
#define VOILE_NEAR_LISTS_ABOVE 8

VOILE_SHARED_BEGIN(voile)

// A collider where it was added, in its own space: the world as it was then (of a box: the box's), seen from `origin`.
// So that what contact computes is as precise far from the world's origin as near to it.
struct ColliderRecord
{
    uint kind;
    uint flags;
    float static_friction;
    float kinetic_friction;
    vec3 box_min;    // m; everything of a mesh is inside. If it deforms: as it was added
    uint first_node; // or box, of a mesh that deforms
    vec3 box_max;
    uint first_triangle; // or leaf
    uint triangles;      // of a mesh, from first_triangle on
    uint layers;         // bits; it meets cloths that have one of them
    uint nodes;          // of a mesh that does not deform, from first_node on
    uint padding;
    vec4 shape;   // plane: unit normal, offset; sphere: w, radius; capsule: half of its axis, radius; box: half of its
                  // size
    vec3 origin;  // m, in the world of a collider that has not moved; of a ball, a capsule and a box the center
    float extent; // m, that a mesh has at most along an axis from there
};

// How a collider goes through the step. Its origin goes straight.
struct ColliderMotion
{
    vec4 rotation_from; // unit quaternions, world from the collider's space
    vec4 rotation_to;
    vec3 origin;     // m, in the world at the step's start, rounded
    uint first_from; // of a mesh that deforms: its first vertex at the start of the step
    vec3 offset_from; // m, of the origin, from there
    uint first_to;   // and at its end
    vec3 offset_to;
    uint padding;
};

// Push constants of the look at which colliders are near.
struct NearCollidersPush
{
    float time;   // s, to the next look
    float sudden; // m/s, that a vertex at rest may come to have until then
    float progress_per_substep;
    uint colliders;
    uint features; // 1: colliders have corners or edges that may meet the cloth
    uint near_stride;
};

// Push constants of the pass that takes a deforming mesh's vertices from what the host gave.
struct DeformPush
{
    mat4 transform;  // the collider's space from the mesh's
    vec3 origin;     // m, of that space in the world
    uint first_word; // of the input
    uint stride;     // words
    uint first_from; // where the vertices are now
    uint first_to;   // where they go
    uint vertices;
};

#ifdef __cplusplus
static_assert(sizeof(ColliderRecord) == 96);
static_assert(offsetof(ColliderRecord, box_min) == 16);
static_assert(offsetof(ColliderRecord, origin) == 80);
static_assert(sizeof(ColliderMotion) == 80);
static_assert(offsetof(ColliderMotion, offset_to) == 64);
static_assert(offsetof(DeformPush, origin) == 64);
#endif

VOILE_SHARED_END

#endif
