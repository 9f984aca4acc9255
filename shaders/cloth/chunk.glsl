// Which vertex of a chunk a thread works on.
//
// The including kernel declares chunks[].
#ifndef VOILE_CHUNK_GLSL
#define VOILE_CHUNK_GLSL

#include "grid.glsl"

struct ChunkVertex
{
    bool exists; // false for the threads beyond the cloth's border
    uint cloth;
    uint local; // counted within the cloth
    uint index; // in the solver's buffers
    uint columns; // of the cloth; of a mesh 0
    uint rows;
    ivec2 place; // column and row in a grid
};

ChunkVertex chunk_vertex(uint chunk, uint thread)
{
    const Chunk c = chunks[chunk];
    ChunkVertex vertex;
    vertex.cloth = c.cloth;
    vertex.columns = c.columns;
    vertex.rows = c.rows;
    if (c.columns > 0)
    {
        vertex.place = ivec2(c.first + (thread & ((1u << c.tile_shift) - 1)), c.row + (thread >> c.tile_shift));
        vertex.exists = in_grid(vertex.place, c.columns, c.rows);
        vertex.local = uint(vertex.place.y) * c.columns + uint(vertex.place.x);
    }
    else
    {
        vertex.place = ivec2(0);
        vertex.local = c.first + thread;
        vertex.exists = vertex.local < c.rows;
    }
    vertex.index = c.first_vertex + vertex.local;
    return vertex;
}

ChunkVertex chunk_vertex(uint chunk) { return chunk_vertex(chunk, gl_LocalInvocationID.x); }

#endif
