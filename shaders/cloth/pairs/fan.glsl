// The primitives that a vertex owns. A triangle or an edge belongs to its vertex with the lowest index. What a vertex
// owns is a part of the fan around it: wedges, each with two spokes b and c.
//
// The including kernel declares cloths[], mesh_vertices[] and mesh_corners[].
#ifndef VOILE_FAN_GLSL
#define VOILE_FAN_GLSL

#include "shared/grid.glsl"
#include "shared/mesh.glsl"

// The vertex in the middle, and its cloth.
struct Fan
{
    uint center;  // in the solver's buffers
    uint local;   // counted within the cloth
    uint columns; // of the cloth; of a mesh 0
    uint wedges;
    ivec2 column_row; // in a grid
    uint rows;
    MeshVertex lists; // of a mesh
};

// Vertices are counted in the solver's buffers.
struct Wedge
{
    uint b;
    uint c;
    bool triangle; // the fan owns center, b, c
    bool edge_b;   // the fan owns center, b
    bool edge_c;
};

Fan fan_of(uint cloth, uint vertex)
{
    Fan fan;
    fan.center = vertex;
    fan.local = vertex - cloths[cloth].first_vertex;
    fan.columns = cloths[cloth].columns;
    fan.rows = cloths[cloth].rows;
    fan.wedges = 2;
    if (fan.columns > 0)
        fan.column_row = ivec2(fan.local % fan.columns, fan.local / fan.columns);
    else
    {
        fan.lists = mesh_vertices[cloths[cloth].first_list + fan.local];
        fan.wedges = fan.lists.corners;
    }
    return fan;
}

MeshCorner fan_corner(Fan fan, uint k) { return mesh_corners[fan.lists.first_corner + k * MESH_STRIDE]; }

// Of the vertices b and c of all wedges, those that are a b count as spokes once, as a b. `wedge`: of which it is the c.
// That of which it is the b often comes before or after: where a vertex has hundreds of triangles, to search through all
// of them for each would take longest, and lavapipe ends loops after 65,535 rounds in all.
bool is_b(Fan fan, uint wedge, uint local)
{
    for (uint k = 0; k < fan.wedges; ++k)
        if (fan_corner(fan, (wedge + fan.wedges - 1 + k) % fan.wedges).b == local)
            return true;
    return false;
}

// A grid's fan has the spokes right, down, down and left. Its cells are cut from the right to the lower vertex.
Wedge grid_wedge(Fan fan, uint k)
{
    const bool right = uint(fan.column_row.x) + 1 < fan.columns;
    const bool left = fan.column_row.x > 0;
    const bool down = uint(fan.column_row.y) + 1 < fan.rows;
    const uint below = fan.center + fan.columns;
    return k == 0 ? Wedge(fan.center + 1, below, right && down, right, false)
                  : Wedge(below, below - 1, left && down, down, left && down);
}

Wedge wedge_of(Fan fan, uint k)
{
    if (fan.columns > 0)
        return grid_wedge(fan, k);
    const MeshCorner corner = fan_corner(fan, k);
    const uint first = fan.center - fan.local;
    const bool b = corner.b > fan.local;
    const bool c = corner.c > fan.local;
    return Wedge(first + corner.b, first + corner.c, b && c, b, c && !is_b(fan, k, corner.c));
}

// The owners of the primitives around a vertex: itself and neighbors with a lower index. Their number, at most.
uint owner_count(Fan fan) { return fan.columns > 0 ? 4 : 1 + 2 * fan.wedges; }

// The k-th of them; the vertex itself is the first. False: there is none.
bool owner_of(Fan fan, uint k, out uint owner)
{
    owner = fan.center;
    if (k == 0)
        return true;
    if (fan.columns > 0)
    {
        const ivec2 offset = k == 1 ? ivec2(-1, 0) : k == 2 ? ivec2(0, -1) : ivec2(1, -1);
        const ivec2 at = fan.column_row + offset;
        owner = uint(int(fan.center) + offset.y * int(fan.columns) + offset.x);
        return in_grid(at, fan.columns, fan.rows);
    }
    const MeshCorner corner = fan_corner(fan, (k - 1) / 2);
    const bool is_c = (k & 1u) == 0;
    const uint local = is_c ? corner.c : corner.b;
    owner = fan.center - fan.local + local;
    return local < fan.local && !(is_c && is_b(fan, (k - 1) / 2, local));
}

#endif
