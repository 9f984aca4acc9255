// Grid topology: which column and row a vertex has, and who its neighbours are.
#ifndef VOILE_GRID_GLSL
#define VOILE_GRID_GLSL

const ivec2 k_spring_offsets[VOILE_SPRING_CLASSES] =
    ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1), ivec2(2, 0), ivec2(0, 2), ivec2(2, 2), ivec2(2, -2));

struct GridVertex
{
    uint index; // in the solver's buffers
    int column;
    int row;
};

GridVertex grid_vertex(uint first_vertex, uint columns, uint local)
{
    GridVertex v;
    v.index = first_vertex + local;
    v.row = int(local / columns);
    v.column = int(local - uint(v.row) * columns);
    return v;
}

bool in_grid(ivec2 p, uint columns, uint rows)
{
    return uint(p.x) < columns && uint(p.y) < rows; // a negative coordinate wraps to a large one
}

uint neighbour(GridVertex v, ivec2 offset, uint columns)
{
    return uint(int(v.index) + offset.y * int(columns) + offset.x);
}

#endif
