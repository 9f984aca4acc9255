// The vertex of a patch that a thread works on.
//
// The including kernel declares patches[].
#ifndef VOILE_PATCH_GLSL
#define VOILE_PATCH_GLSL

#include "shared/patch_size.glsl"
#include "shared/patch_vertex.glsl"

PatchVertex patch_vertex(uint patch_index, uint thread)
{
    const Patch c = patches[patch_index];
    PatchVertex vertex;
    vertex.cloth = c.cloth;
    vertex.columns = c.columns;
    vertex.rows = c.rows;
    vertex.asleep = (c.tile & VOILE_PATCH_ASLEEP) != 0;
    const uint tile_shift = c.tile & VOILE_PATCH_TILE_SHIFT;
    if (c.columns > 0)
    {
        vertex.column_row = ivec2(c.first + (thread & ((1u << tile_shift) - 1)), c.row + (thread >> tile_shift));
        vertex.exists = in_grid(vertex.column_row, c.columns, c.rows);
        vertex.local = uint(vertex.column_row.y) * c.columns + uint(vertex.column_row.x);
    }
    else
    {
        vertex.column_row = ivec2(0);
        vertex.local = c.first + thread;
        vertex.exists = vertex.local < c.rows;
    }
    vertex.index = c.first_vertex + vertex.local;
    return vertex;
}

// The patch of the workgroup, in a dispatch over a batch or over its patches that are awake.
uint patch_of_batch(uint first_patch)
{
    const uint slot = (first_patch & ~VOILE_AWAKE_PATCHES) + gl_WorkGroupID.x;
    const bool awake = (first_patch & VOILE_AWAKE_PATCHES) != 0;
    return awake ? patches[slot].tile >> VOILE_PATCH_AWAKE_SHIFT : slot;
}

PatchVertex patch_vertex(uint patch_index) { return patch_vertex(patch_index, gl_LocalInvocationID.x % PATCH_SIZE); }

#endif
