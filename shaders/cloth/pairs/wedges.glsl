// The primitives that a vertex owns. A triangle or an edge belongs to its vertex with the lowest index. What a vertex
// owns is a part of the fan around it: wedges, each with two spokes b and c. Those of meshes are listed (mesh_fans.cpp).
//
// The including kernel declares cloths[], mesh_fans[] and mesh_wedges[].
#ifndef VOILE_WEDGES_GLSL
#define VOILE_WEDGES_GLSL

#include "pairs/fan.glsl"

// Vertices are counted in the solver's buffers.
struct Wedge
{
    uint b;
    uint c;
    bool triangle; // the fan owns center, b, c
    bool edge_b;   // the fan owns center, b
    bool edge_c;
};

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
    const MeshWedge wedge = mesh_wedges[fan.mesh.first_wedge + k];
    const uint first = fan.center - fan.local;
    const uint b = wedge.b & ~VOILE_SPOKE_BIT;
    const uint c = wedge.c & ~VOILE_SPOKE_BIT;
    return Wedge(first + b, first + c, b != c, (wedge.b & VOILE_SPOKE_BIT) != 0, (wedge.c & VOILE_SPOKE_BIT) != 0);
}

#endif
