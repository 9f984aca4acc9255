// Grid topology: the neighbors of a vertex.
#ifndef VOILE_GRID_GLSL
#define VOILE_GRID_GLSL

#include "shared/grid_springs.h"

const ivec2 k_spring_offsets[VOILE_SPRING_CLASSES] = ivec2[](VOILE_SPRING_OFFSETS);

bool in_grid(ivec2 p, uint columns, uint rows)
{
    return uint(p.x) < columns && uint(p.y) < rows; // a negative coordinate wraps to a large one
}

uint neighbor(uint index, ivec2 offset, uint columns)
{
    return uint(int(index) + offset.y * int(columns) + offset.x);
}

#endif
