#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Refit of an implicit complete BVH: computes the boxes of one level and folds them several levels up. The first
// dispatch computes the boxes of the last level from the vertices. Each following dispatch starts where the one before
// ended. The last one ends at the root.
//
// A subtree whose root is box `root` on a level of m boxes consists of the boxes root, root + m, root + 2 m, ... of the
// levels below: j levels down its k-th box is root + k m for k < 2^j, and folds boxes k and k + 2^j of the next level.
// A workgroup takes neighboring roots, so that it reads and writes runs of neighboring boxes. A thread computes one
// half of a box, its minimum or its maximum, so that stores of neighboring threads fill a run of memory. Threads fold
// the boxes that they hold in registers, then in shared memory.
#include "shared/bindings.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in; // a power of two, at least 2
layout(constant_id = k_constant_from_leaves) const uint FROM_LEAVES = 1;

layout(VOILE_BINDING(cloth_trees)) readonly buffer ClothTrees { TreeRecord cloth_trees[]; };
layout(VOILE_BINDING(refit_leaves)) readonly buffer RefitLeaves { PaddedLeaf leaves[]; };
layout(VOILE_BINDING(refit_positions)) readonly buffer RefitPositions { vec4 positions[]; };
layout(VOILE_BINDING(refit_boxes)) buffer RefitBoxes { vec4 box_halves[]; }; // PaddedBox: minimum, maximum, ...

layout(push_constant, std430) uniform Push { RefitPush push; };

// min() is no constant expression.
const uint RUN = gl_WorkGroupSize.x / 2 < VOILE_REFIT_RUN ? gl_WorkGroupSize.x / 2 : VOILE_REFIT_RUN;
const uint LANES = 2 * RUN;
const uint ROWS = gl_WorkGroupSize.x / LANES;

shared vec3 shared_halves[gl_WorkGroupSize.x];

// The part of a subtree that a thread folds.
struct Fold
{
    TreeRecord tree;
    bool upper; // whether it computes maxima
    uint root;  // of its subtree, on its level
    uint roots; // number of boxes of that level
    uint row;   // its boxes of the bottom level are the subtree's row-th, (row + ROWS)-th, ...
};

vec3 fold(bool upper, vec3 a, vec3 b) { return upper ? max(a, b) : min(a, b); }

// The neutral element of fold.
vec3 neutral(bool upper) { return vec3(upper ? uintBitsToFloat(0xff800000u) : uintBitsToFloat(0x7f800000u)); }

// The index of the subtree's k-th box on the level on which it has `width` boxes.
uint half_index(Fold self, uint k, uint width)
{
    return 2 * (self.tree.first_box + self.roots * (width + k) - 1 + self.root) + uint(self.upper);
}

void store(Fold self, uint k, uint width, vec3 value)
{
    if (self.root < self.roots)
        box_halves[half_index(self, k, width)] = vec4(value, 0);
}

bool is_finite(uvec3 corners)
{
    const vec3 sum =
        abs(positions[corners.x].xyz) + abs(positions[corners.y].xyz) + abs(positions[corners.z].xyz);
    return !any(isnan(sum)) && !any(isinf(sum));
}

vec3 triangle_half(bool upper, uvec3 corners)
{
    return fold(upper, fold(upper, positions[corners.x].xyz, positions[corners.y].xyz), positions[corners.z].xyz);
}

// A triangle with a corner that is not finite has an empty box, so that it does not spoil those above it.
vec3 leaf_half(bool upper, TreeRecord tree, uint slot)
{
    const uvec3 corners = leaves[tree.first_leaf + slot].corners;
    const vec3 start = triangle_half(upper, tree.first_from + corners);
    const vec3 end = triangle_half(upper, tree.first_to + corners);
    const vec3 value = fold(upper, start, end);
    return is_finite(tree.first_from + corners) && is_finite(tree.first_to + corners) ? value : neutral(upper);
}

// The subtree's k-th box of the bottom level. A tree may have fewer levels than a dispatch can fold. Boxes that it lacks
// are neutral.
vec3 bottom_half(Fold self, uint k)
{
    const uint width = 1u << push.levels;
    if (self.root >= self.roots || k >= width)
        return neutral(self.upper);
    if (FROM_LEAVES == 0)
        return box_halves[half_index(self, k, width)].xyz;
    const vec3 value = leaf_half(self.upper, self.tree, self.root + k * self.roots);
    store(self, k, width, value);
    return value;
}

vec3 fold_in_registers(Fold self)
{
    const uint width = 1u << push.levels;
    vec3 values[VOILE_REFIT_ITEMS];
    [[unroll]] for (uint i = 0; i < VOILE_REFIT_ITEMS; ++i)
        values[i] = bottom_half(self, self.row + i * ROWS);
    [[unroll]] for (uint items = VOILE_REFIT_ITEMS / 2; items > 0; items /= 2)
        [[unroll]] for (uint i = 0; i < items; ++i)
        {
            values[i] = fold(self.upper, values[i], values[i + items]);
            if (items * ROWS < width)
                store(self, self.row + i * ROWS, items * ROWS, values[i]);
        }
    return values[0];
}

void fold_rows(Fold self, vec3 value)
{
    const uint thread = gl_LocalInvocationID.x;
    shared_halves[thread] = value;
    for (uint rows = ROWS / 2; rows > 0; rows /= 2)
    {
        barrier();
        if (self.row >= rows)
            continue;
        value = fold(self.upper, value, shared_halves[thread + rows * LANES]);
        shared_halves[thread] = value;
        if (rows < 1u << push.levels)
            store(self, self.row, rows, value);
    }
}

void main()
{
    const uint lane = gl_LocalInvocationID.x % LANES;
    TreeRecord tree = push.tree;
    if (push.first_tree != VOILE_TREE_IN_PUSH)
        tree = cloth_trees[push.first_tree + gl_WorkGroupID.y];
    const Fold self = Fold(tree, lane % 2 == 1, gl_WorkGroupID.x * RUN + lane / 2,
                           1u << (push.bottom - push.levels), gl_LocalInvocationID.x / LANES);
    fold_rows(self, fold_in_registers(self));
}
