// The bounding volume hierarchy as the GPU reads it. Written by modules/cloth/src/geometry/bvh.cpp, read by
// mesh_traversal.glsl.
#ifndef VOILE_BVH_LAYOUT_H
#define VOILE_BVH_LAYOUT_H

#include "../../shared_types.h"

VOILE_SHARED_BEGIN(voile)

// An inner node contains the boxes of both its children, so that one 64-byte read decides about two subtrees. A child
// is the index of an inner node, or, with the highest bit set, a leaf: bits 29-30 are its triangle count minus one (1
// to 4), bits 0-28 the index of its first triangle. Node 0 is the root. It always exists. A mesh that fits one leaf
// gives the root one child, and its right box is empty: min = +infinity, max = -infinity.
struct BvhNode
{
    vec3 left_min;
    uint left;
    vec3 left_max;
    uint padding_0;
    vec3 right_min;
    uint right;
    vec3 right_max;
    uint padding_1;
};

// A triangle in leaf order.
struct BvhTriangle
{
    vec3 a;
    uint index; // in the mesh that the tree was built from
    vec3 b;
    uint padding_0;
    vec3 c;
    uint padding_1;
};

VOILE_SHARED_END

#define VOILE_BVH_LEAF_BIT 0x80000000u
#define VOILE_BVH_COUNT_SHIFT 29
#define VOILE_BVH_COUNT_MASK 3u
#define VOILE_BVH_FIRST_MASK 0x1fffffffu
// The size of the traversal's stack, one entry per level. The builder never makes a deeper tree.
#define VOILE_BVH_MAX_DEPTH 48

#endif
