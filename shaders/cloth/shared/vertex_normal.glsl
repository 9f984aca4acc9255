// The normal of a vertex. The including kernel defines VOILE_NORMAL_POSITIONS and VOILE_NORMAL_RESIDUALS as the names
// of the buffers to read, and declares cloths[], mesh_vertices[] and mesh_corners[].
#ifndef VOILE_VERTEX_NORMAL_GLSL
#define VOILE_VERTEX_NORMAL_GLSL

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "shared/mesh.glsl"

vec3 vertex_delta(uint from, uint to)
{
    const vec3 a = VOILE_NORMAL_POSITIONS[from].xyz;
    const vec3 b = VOILE_NORMAL_POSITIONS[to].xyz;
    return displacement(FinePosition(a, unpack_residual(VOILE_NORMAL_RESIDUALS[from])),
                        FinePosition(b, unpack_residual(VOILE_NORMAL_RESIDUALS[to])));
}

vec3 neighbor_delta(PatchVertex self, ivec2 offset, uint columns, uint rows)
{
    if (!in_grid(self.column_row + offset, columns, rows))
        return vec3(0);
    return vertex_delta(self.index, neighbor(self.index, offset, columns));
}

// The area-weighted normal of the four quadrants around the vertex: E x N + N x W + W x S + S x E = (E - W) x (N - S).
// It points up for a flat grid seen from above.
vec3 grid_normal(PatchVertex self, uint columns, uint rows)
{
    const vec3 along_row = neighbor_delta(self, ivec2(1, 0), columns, rows) -
                           neighbor_delta(self, ivec2(-1, 0), columns, rows);
    const vec3 along_column = neighbor_delta(self, ivec2(0, 1), columns, rows) -
                              neighbor_delta(self, ivec2(0, -1), columns, rows);
    return cross(along_column, along_row);
}

// The area-weighted normal of the triangles around the vertex.
vec3 mesh_normal(uint cloth, uint local)
{
    const uint first_vertex = cloths[cloth].first_vertex;
    const MeshVertex vertex = mesh_vertices[cloths[cloth].first_list + local];
    vec3 sum = vec3(0);
    for (uint c = 0; c < vertex.corners; ++c)
    {
        const MeshCorner corner = mesh_corners[vertex.first_corner + c * MESH_STRIDE];
        sum += cross(vertex_delta(first_vertex + local, first_vertex + corner.b),
                     vertex_delta(first_vertex + local, first_vertex + corner.c));
    }
    return sum;
}

vec3 vertex_normal(PatchVertex self)
{
    const uint columns = cloths[self.cloth].columns;
    const vec3 n = columns > 0 ? grid_normal(self, columns, cloths[self.cloth].rows) : mesh_normal(self.cloth, self.local);
    const float length_squared = dot(n, n);
    return length_squared > 1e-30 ? n * inversesqrt(length_squared) : vec3(0, 1, 0);
}

#endif
