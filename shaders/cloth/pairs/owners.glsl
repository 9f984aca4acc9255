// The owners of the primitives around a vertex (wedges.glsl): itself, and neighbors with a lower index.
//
// The including kernel declares cloths[], mesh_fans[] and mesh_owners[].
#ifndef VOILE_OWNERS_GLSL
#define VOILE_OWNERS_GLSL

#include "pairs/fan.glsl"

// Their number, at most.
uint owner_count(Fan fan) { return fan.columns > 0 ? 4 : 1 + fan.mesh.owners; }

// The k-th of them; the vertex itself is the first. False: there is none.
bool owner_of(Fan fan, uint k, out uint owner)
{
    owner = fan.center;
    if (k == 0)
        return true;
    if (fan.columns == 0)
    {
        owner = fan.center - fan.local + mesh_owners[fan.mesh.first_owner + k - 1];
        return true;
    }
    const ivec2 offset = k == 1 ? ivec2(-1, 0) : k == 2 ? ivec2(0, -1) : ivec2(1, -1);
    owner = uint(int(fan.center) + offset.y * int(fan.columns) + offset.x);
    return in_grid(fan.column_row + offset, fan.columns, fan.rows);
}

#endif
