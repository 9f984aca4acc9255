// The triangles around a vertex of a cloth, and the lists of features near them.
//
// The including kernel declares cloths[], mesh_vertices[] and mesh_corners[], and includes patch.glsl and mesh.glsl
// before.
#ifndef VOILE_FEATURE_FAN_GLSL
#define VOILE_FEATURE_FAN_GLSL

// The neighbors of a grid vertex in order. Cells are cut into two triangles from (column + 1, row) to (column, row +
// 1).
const ivec2 k_ring[6] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, -1));
// The cells of the triangles between them: the offset of the first vertex.
const ivec2 k_ring_cells[6] = ivec2[](ivec2(0, 0), ivec2(-1, 0), ivec2(-1, 0), ivec2(-1, -1), ivec2(0, -1), ivec2(0, -1));

// The number of triangles that there may be around the vertex.
uint corner_count(PatchVertex self)
{
    return self.columns > 0 ? 6 : mesh_vertices[cloths[self.cloth].first_list + self.local].corners;
}

// The other two corners of the k-th triangle. False: outside of a grid; `b` may exist all the same.
bool find_corner(PatchVertex self, uint k, out uint b, out uint c)
{
    if (self.columns == 0)
    {
        const uint first = mesh_vertices[cloths[self.cloth].first_list + self.local].first_corner;
        const MeshCorner corner = mesh_corners[first + k * MESH_STRIDE];
        b = self.index - self.local + corner.b;
        c = self.index - self.local + corner.c;
        return true;
    }
    const ivec2 to_b = k_ring[k];
    const ivec2 to_c = k_ring[(k + 1) % 6];
    b = neighbor(self.index, to_b, self.columns);
    c = neighbor(self.index, to_c, self.columns);
    return in_grid(self.column_row + to_b, self.columns, self.rows) &&
           in_grid(self.column_row + to_c, self.columns, self.rows);
}

// Whether the vertex b of the k-th triangle exists, though the triangle may not.
bool has_spoke(PatchVertex self, uint k)
{
    return self.columns == 0 || in_grid(self.column_row + k_ring[k], self.columns, self.rows);
}

// The list of the k-th triangle. In a grid each triangle has one, which its three vertices share. An edge on the border
// is in the list of the triangle before it. The triangles around a vertex of a mesh share two.
uint list_of(PatchVertex self, uint k, bool triangle)
{
    if (self.columns == 0)
        return VOILE_FEATURE_LISTS * self.index + k % VOILE_FEATURE_LISTS;
    const uint of = triangle ? k : (k + 5) % 6;
    return VOILE_FEATURE_LISTS * neighbor(self.index, k_ring_cells[of], self.columns) + of % VOILE_FEATURE_LISTS;
}

#endif
