#version 460
#extension GL_GOOGLE_include_directive : require
// Vertex normals for drawing, from the neighbors of each vertex. One thread per vertex.
// Reads: cloths, patches, mesh lists, positions and residuals. Writes: normals (w = 0).
#include "shared/cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Patches { Patch patches[]; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Normals { vec4 normals[]; };
layout(set = 0, binding = 4, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 5, std430) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(set = 0, binding = 6, std430) readonly buffer Residuals { uvec2 residuals[]; };

#define VOILE_NORMAL_POSITIONS positions
#define VOILE_NORMAL_RESIDUALS residuals
#include "shared/vertex_normal.glsl"

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (self.exists)
        normals[self.index] = vec4(vertex_normal(self), 0);
}
