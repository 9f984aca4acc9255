// The hierarchy of a cloth, or of a collider that deforms: an implicit complete BVH. Built by
// modules/cloth/src/geometry/padded_tree.cpp. Its boxes are written by refit.comp and read by padded.glsl.
#ifndef VOILE_PADDED_LAYOUT_H
#define VOILE_PADDED_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// A tree over n triangles is complete. Level d has 2^d boxes, and the last level, D = ceil(log2 n), one box per slot.
// The boxes are stored level by level. Level d begins at index 2^d - 1 of the tree. The children of box i on a level of
// m boxes are boxes i and i + m of the next level. Therefore the ancestor of slot s on level d is box s mod 2^d.
struct PaddedBox
{
    vec3 min; // m; of a collider, of the whole step
    uint padding_0;
    vec3 max;
    uint padding_1;
};

// The triangle in a slot. The first n slots have one each. A slot s past them repeats its sibling, slot s - 2^(D-1).
// Each edge of the mesh, a pair of its vertices, is owned by one triangle. Edge i joins corners i and (i + 1) % 3.
struct PaddedLeaf
{
    uvec3 corners; // vertices of the mesh
    uint triangle; // of the mesh, the edges that it owns from VOILE_PADDED_EDGE_SHIFT on, and VOILE_PADDED_REPEAT
};

// A tree in its buffers.
struct TreeRecord
{
    uint first_box;
    uint first_leaf;
    uint first_from; // of the mesh's vertices at the step's start
    uint first_to;   // of the mesh's vertices at the step's end; may be the same ones
    uint triangles;
    uint cloth; // of a cloth: its index
    uint padding_0;
    uint padding_1;
};

// Push constants of a dispatch that folds boxes `levels` levels up from level `bottom`. Row y of its workgroups works
// on tree first_tree + y of the table. Without a table, it works on `tree`.
struct RefitPush
{
    TreeRecord tree;
    uint first_tree; // or VOILE_TREE_IN_PUSH
    uint bottom;
    uint levels;
};

#ifdef __cplusplus
static_assert(sizeof(TreeRecord) == 32);
#endif

VOILE_SHARED_END

// Set in PaddedLeaf.triangle: the slot repeats the triangle of another slot.
#define VOILE_PADDED_REPEAT 0x80000000u
// The edges that the triangle in a slot owns, one bit each.
#define VOILE_PADDED_EDGE_SHIFT 28
#define VOILE_PADDED_TRIANGLE_MASK 0x0fffffffu
#define VOILE_TREE_IN_PUSH 0xffffffffu
// The number of boxes of the bottom level that a thread of a refit folds. A power of two.
#define VOILE_REFIT_ITEMS 8
// The number of contiguous boxes that neighboring threads fold, if the workgroup is large enough.
#define VOILE_REFIT_RUN 8

#endif
