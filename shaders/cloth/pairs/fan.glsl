// A vertex with the primitives around it.
//
// The including kernel declares cloths[] and mesh_fans[].
#ifndef VOILE_FAN_GLSL
#define VOILE_FAN_GLSL

#include "shared/grid.glsl"

// The vertex in the middle, and its cloth.
struct Fan
{
    uint center;  // in the solver's buffers
    uint local;   // counted within the cloth
    uint columns; // of the cloth; of a mesh 0
    uint wedges; // that it owns (wedges.glsl)
    ivec2 column_row; // in a grid
    uint rows;
    MeshFan mesh; // of a mesh
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
        fan.mesh = mesh_fans[cloths[cloth].first_fan + fan.local];
        fan.wedges = fan.mesh.wedges;
    }
    return fan;
}

#endif
