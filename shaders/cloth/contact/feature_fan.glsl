// The triangles around a vertex of a cloth, and the pieces of cloth that a vertex has: triangles and edges, each of one
// vertex in a grid.
//
// The including kernel declares cloths[], mesh_vertices[] and mesh_corners[], and includes patch.glsl and mesh.glsl
// before.
#ifndef VOILE_FEATURE_FAN_GLSL
#define VOILE_FEATURE_FAN_GLSL

// The neighbors of a grid vertex in order. Cells are cut into two triangles from (column + 1, row) to (column, row +
// 1).
const ivec2 k_ring[6] = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, -1));

// The vertices of a grid's cell, and those of its pieces: two triangles, three edges, and those on the border of the
// grid.
const ivec2 k_cell[4] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));
const uvec3 k_cell_pieces[7] = uvec3[](uvec3(0, 1, 3), uvec3(1, 2, 3), uvec3(0, 1, 1), uvec3(0, 3, 3), uvec3(1, 3, 3),
                                       uvec3(1, 2, 2), uvec3(3, 2, 2));

// The number of triangles that there may be around the vertex.
uint corner_count(PatchVertex self)
{
    return self.columns > 0 ? 6 : mesh_vertices[cloths[self.cloth].first_list + self.local].corners;
}

MeshCorner mesh_corner(PatchVertex self, uint k)
{
    const uint first = mesh_vertices[cloths[self.cloth].first_list + self.local].first_corner;
    return mesh_corners[first + k * MESH_STRIDE];
}

// The other two corners of the k-th triangle. False: outside of a grid; `b` may exist all the same.
bool find_corner(PatchVertex self, uint k, out uint b, out uint c)
{
    if (self.columns == 0)
    {
        const MeshCorner corner = mesh_corner(self, k);
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

// The vertices of a piece. An edge repeats its second one.
uvec3 piece_vertices(PatchVertex self, uint kind, uint k)
{
    if (self.columns > 0)
        return uvec3(neighbor(self.index, k_cell[k_cell_pieces[k].x], self.columns),
                     neighbor(self.index, k_cell[k_cell_pieces[k].y], self.columns),
                     neighbor(self.index, k_cell[k_cell_pieces[k].z], self.columns));
    uint b;
    uint c;
    find_corner(self, k, b, c);
    return uvec3(self.index, kind == VOILE_PIECE_EDGE_C ? c : b, kind == VOILE_PIECE_EDGE_B ? b : c);
}

// The vertices that the pieces of a vertex have: of a grid those of its cell.
uint cell_count(PatchVertex self) { return self.columns > 0 ? 4 : 1 + 2 * corner_count(self); }

// Guards share the vertices of a mesh's cell: at most five each, so that none waits for long, or an eighth of a large fan.
// Guard 0 is of the whole cell, those that share it are numbered from 1 on.
uint guard_triangles(PatchVertex self) { return max(2, (corner_count(self) + 7) / 8); }
uint guard_count(PatchVertex self) { return (corner_count(self) + guard_triangles(self) - 1) / guard_triangles(self); }

// The first vertex of the k-th guard in the cell, and the first after its last one.
uvec2 guarded_range(PatchVertex self, uint k)
{
    if (k == 0)
        return uvec2(0, cell_count(self));
    const uint vertices = 2 * guard_triangles(self);
    return uvec2(k == 1 ? 0 : 1 + vertices * (k - 1), min(1 + vertices * k, cell_count(self)));
}

// False: outside of the grid.
bool find_in_cell(PatchVertex self, uint i, out uint vertex)
{
    vertex = self.index;
    if (self.columns > 0)
    {
        vertex = neighbor(self.index, k_cell[i], self.columns);
        return in_grid(self.column_row + k_cell[i], self.columns, self.rows);
    }
    if (i > 0)
    {
        const MeshCorner corner = mesh_corner(self, (i - 1) / 2);
        vertex = self.index - self.local + (i % 2 == 1 ? corner.b : corner.c);
    }
    return true;
}

#endif
