// The hierarchy of a mesh that deforms, as the GPU folds and traverses it. Built by modules/cloth/src/padded_tree.cpp,
// its boxes written by refit.comp, read by padded.glsl.
#ifndef VOILE_PADDED_LAYOUT_H
#define VOILE_PADDED_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// A tree over n triangles is complete: level d holds 2^d boxes, the last level D = ceil(log2 n) one box a slot. The
// boxes stand level by level, level d from index 2^d - 1 of the tree on. The children of box i on a level of m boxes
// are boxes i and i + m of the next; so the box above slot s on level d is box s mod 2^d.
struct PaddedBox
{
    vec3 min; // m, of the whole step
    uint padding_0;
    vec3 max;
    uint padding_1;
};

// What stands in a slot: a triangle. The first n slots have one each; slot s past them repeats slot s - 2^(D-1), its
// sibling.
struct PaddedLeaf
{
    uvec3 corners; // vertices of the mesh
    uint triangle; // of the mesh; VOILE_PADDED_REPEAT
};

// Push constants of a dispatch that folds boxes `levels` levels up from level `bottom`.
struct RefitPush
{
    uint first_box;
    uint first_leaf;
    uint first_from; // of the mesh's vertices where the step starts
    uint first_to;   // and where it ends
    uint bottom;
    uint levels;
};

VOILE_SHARED_END

// Set in PaddedLeaf.triangle: the slot repeats a triangle that stands in another one.
#define VOILE_PADDED_REPEAT 0x80000000u
// A thread of a refit takes this many boxes of the bottom level (a power of two),
#define VOILE_REFIT_ITEMS 8
// and threads side by side take as many boxes that stand side by side, if the workgroup is large enough.
#define VOILE_REFIT_RUN 8

#endif
