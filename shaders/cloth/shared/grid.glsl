// Grid topology: the neighbors of a vertex.
#ifndef VOILE_GRID_GLSL
#define VOILE_GRID_GLSL

const ivec2 k_spring_offsets[VOILE_SPRING_CLASSES] =
    ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1), ivec2(2, 0), ivec2(0, 2), ivec2(2, 2), ivec2(2, -2));

bool in_grid(ivec2 p, uint columns, uint rows)
{
    return uint(p.x) < columns && uint(p.y) < rows; // a negative coordinate wraps to a large one
}

uint neighbor(uint index, ivec2 offset, uint columns)
{
    return uint(int(index) + offset.y * int(columns) + offset.x);
}

#endif
