// The normal of a grid vertex, from the buffer that the including kernel names VOILE_NORMAL_POSITIONS.
#ifndef VOILE_GRID_NORMAL_GLSL
#define VOILE_GRID_NORMAL_GLSL

#include "grid.glsl"

vec3 neighbour_delta(GridVertex self, ivec2 offset, uint columns, uint rows)
{
    if (!in_grid(ivec2(self.column, self.row) + offset, columns, rows))
        return vec3(0);
    return VOILE_NORMAL_POSITIONS[neighbour(self, offset, columns)].xyz - VOILE_NORMAL_POSITIONS[self.index].xyz;
}

// The sum of the cross products of consecutive neighbours around the vertex, E x N + N x W + W x S + S x E, is the one
// product (E - W) x (N - S): the area-weighted normal of the four quadrants. Up for a flat grid seen from above.
vec3 grid_normal(GridVertex self, uint columns, uint rows)
{
    const vec3 along_row = neighbour_delta(self, ivec2(1, 0), columns, rows) -
                           neighbour_delta(self, ivec2(-1, 0), columns, rows);
    const vec3 along_column = neighbour_delta(self, ivec2(0, 1), columns, rows) -
                              neighbour_delta(self, ivec2(0, -1), columns, rows);
    const vec3 n = cross(along_column, along_row);
    const float length_squared = dot(n, n);
    return length_squared > 1e-30 ? n * inversesqrt(length_squared) : vec3(0, 1, 0);
}

#endif
