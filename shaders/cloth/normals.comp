#version 460
#extension GL_GOOGLE_include_directive : require
// Vertex normals for drawing. A thread computes one vertex's normal from its four grid neighbours.
// Reads: cloths, chunks, positions. Writes: normals (w = 0).
#include "cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Normals { vec4 normals[]; };

#define VOILE_NORMAL_POSITIONS positions
#include "grid_normal.glsl"

void main()
{
    const Chunk chunk = chunks[gl_WorkGroupID.x];
    const uint columns = cloths[chunk.cloth].columns;
    const uint rows = cloths[chunk.cloth].rows;
    const GridVertex self =
        grid_vertex(cloths[chunk.cloth].first_vertex, columns, rows, chunk.first + gl_LocalInvocationID.x);
    if (self.exists)
        normals[self.index] = vec4(grid_normal(self, columns, rows), 0);
}
