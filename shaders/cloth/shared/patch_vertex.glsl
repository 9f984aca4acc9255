// A vertex of a cloth, and where it is in the cloth.
#ifndef VOILE_PATCH_VERTEX_GLSL
#define VOILE_PATCH_VERTEX_GLSL

#include "shared/grid.glsl"

struct PatchVertex
{
    bool exists; // false for threads beyond the cloth's border
    bool asleep; // the cloth sleeps in this step: passes that change the state leave it alone
    uint cloth;
    uint local; // counted within the cloth
    uint index; // in the solver's buffers
    uint columns; // of the cloth; of a mesh 0
    uint rows;
    ivec2 column_row; // in a grid
};

#endif
