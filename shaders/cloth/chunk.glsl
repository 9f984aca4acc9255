// Which vertex of a chunk a thread works on.
//
// The including kernel declares cloths[] and chunks[].
#ifndef VOILE_CHUNK_GLSL
#define VOILE_CHUNK_GLSL

#include "grid.glsl"

struct ChunkVertex
{
    bool exists; // false for the threads beyond the cloth's border
    uint cloth;
    uint local; // counted within the cloth
    uint index; // in the solver's buffers
    ivec2 place; // column and row in a grid
};

ChunkVertex chunk_vertex(uint chunk, uint thread)
{
    ChunkVertex vertex;
    const uint shift = chunks[chunk].tile_shift;
    vertex.cloth = chunks[chunk].cloth;
    const uint columns = cloths[vertex.cloth].columns;
    if (columns > 0)
    {
        vertex.place = ivec2(chunks[chunk].first + (thread & ((1u << shift) - 1)), chunks[chunk].row + (thread >> shift));
        vertex.exists = in_grid(vertex.place, columns, cloths[vertex.cloth].rows);
        vertex.local = uint(vertex.place.y) * columns + uint(vertex.place.x);
    }
    else
    {
        vertex.place = ivec2(0);
        vertex.local = chunks[chunk].first + thread;
        vertex.exists = vertex.local < cloths[vertex.cloth].vertices;
    }
    vertex.index = cloths[vertex.cloth].first_vertex + vertex.local;
    return vertex;
}

ChunkVertex chunk_vertex(uint chunk) { return chunk_vertex(chunk, gl_LocalInvocationID.x); }

#endif
