// The hierarchy of a mesh that deforms: an implicit complete BVH. Built by modules/cloth/src/geometry/padded_tree.cpp.
// Its boxes are written by refit.comp and read by padded.glsl.
#ifndef VOILE_PADDED_LAYOUT_H
#define VOILE_PADDED_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// A tree over n triangles is complete. Level d has 2^d boxes, and the last level, D = ceil(log2 n), one box per slot.
// The boxes are stored level by level. Level d begins at index 2^d - 1 of the tree. The children of box i on a level of
// m boxes are boxes i and i + m of the next level. Therefore the ancestor of slot s on level d is box s mod 2^d.
struct PaddedBox
{
    vec3 min; // m, of the whole step
    uint padding_0;
    vec3 max;
    uint padding_1;
};

// The triangle in a slot. The first n slots have one each. A slot s past them repeats its sibling, slot s - 2^(D-1).
struct PaddedLeaf
{
    uvec3 corners; // vertices of the mesh
    uint triangle; // of the mesh, and VOILE_PADDED_REPEAT
};

// Push constants of a dispatch that folds boxes `levels` levels up from level `bottom`.
struct RefitPush
{
    uint first_box;
    uint first_leaf;
    uint first_from; // of the mesh's vertices at the step's start
    uint first_to;   // of the mesh's vertices at the step's end
    uint bottom;
    uint levels;
};

VOILE_SHARED_END

// Set in PaddedLeaf.triangle: the slot repeats the triangle of another slot.
#define VOILE_PADDED_REPEAT 0x80000000u
// The number of boxes of the bottom level that a thread of a refit folds. A power of two.
#define VOILE_REFIT_ITEMS 8
// The number of contiguous boxes that neighboring threads fold, if the workgroup is large enough.
#define VOILE_REFIT_RUN 8

#endif
