// Colliders, their motions, and the lists of colliders near patches, as the GPU reads them. Hierarchies of meshes are
// in bvh_layout.h and padded_layout.h, feature edges and feature vertices in feature_layout.h.
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
#define VOILE_COLLIDER_FRICTION 2u  // it has its own friction coefficients
#define VOILE_COLLIDER_ONE_SIDED 4u // a mesh pushes to the side that it faces; otherwise to where a vertex came from
#define VOILE_COLLIDER_MOVED 8u     // its pose differs, or differed, from the one at which it was added: ColliderMotion
#define VOILE_COLLIDER_DEFORMS 16u  // a mesh whose vertices move: its hierarchy is an implicit BVH (padded_layout.h)

// The words of a patch's list of near colliders (find_near_colliders.comp): the box in which the list is valid, the
// range of its words of bits that are not 0, and then the bits, one per collider.
#define VOILE_NEAR_MIN 0
#define VOILE_NEAR_FIRST 3
#define VOILE_NEAR_MAX 4
#define VOILE_NEAR_END 7
#define VOILE_NEAR_WORDS 8
// With this many colliders or fewer there are no lists.
#define VOILE_NEAR_LISTS_ABOVE 8

VOILE_SHARED_BEGIN(voile)

// A collider in its own space: the world at the time when it was added (for a box, the space of the box), relative to
// `origin`. Contact computes in this space, so that it is as precise far from the world's origin as near to it.
struct ColliderRecord
{
    uint kind;
    uint flags;
    float static_friction;
    float kinetic_friction;
    vec3 box_min;    // m, the bounds of a mesh; if it deforms, at the time when it was added
    uint first_node; // of a mesh; if it deforms, its first box
    vec3 box_max;
    uint first_triangle; // of a mesh; if it deforms, its first leaf
    uint triangles;      // of a mesh, from first_triangle on
    uint layers;         // bits; the collider collides with cloths that have one of them
    uint nodes;          // of a mesh that does not deform, from first_node on
    uint padding;
    vec4 shape;   // plane: unit normal, offset; sphere: w is the radius; capsule: half axis, radius; box: half size
    vec3 origin;  // m, in the world before any motion; of a sphere, a capsule and a box the center
    float extent; // m, the largest extent of a mesh from its origin along an axis
};

// The motion of a collider in the step. Its origin moves along a straight line.
struct ColliderMotion
{
    vec4 rotation_from; // unit quaternions, world from the collider's space
    vec4 rotation_to;
    vec3 origin;      // m, in the world at the step's start, rounded
    uint first_from;  // of a mesh that deforms: its first vertex at the start of the step
    vec3 offset_from; // m, from `origin` to the collider's origin at the start of the step
    uint first_to;    // of a mesh that deforms: its first vertex at the end of the step
    vec3 offset_to;   // m, from `origin` to the collider's origin at the end of the step
    uint halves; // of a mesh that deforms: bit 0 says which half of its data is of the step's start, bit 1 of its end
};

// Push constants of the query for near colliders. Times are in substeps of level 0.
struct NearCollidersPush
{
    float substeps; // to the next query
    float progress_per_substep;
    uint colliders;
    uint features; // 1: colliders have features that may touch the cloth
    uint near_stride;
    uint first_patch; // of the dispatch
};

// Push constants of the pass that transforms the vertices that the host gives for a deforming mesh.
struct DeformPush
{
    mat4 transform;  // the collider's space from the mesh's space
    vec3 origin;     // m, of the collider's space in the world
    uint first_word; // of the input
    uint stride;     // words
    uint first_from; // of the current vertices
    uint first_to;   // of the result
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
