#version 460
#extension GL_GOOGLE_include_directive : require
// Vertex normals for drawing, from the neighbors of each vertex. One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(normals)) writeonly buffer Normals { vec4 normals[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(residuals)) readonly buffer Residuals { uvec2 residuals[]; };

#define VOILE_NORMAL_POSITIONS positions
#define VOILE_NORMAL_RESIDUALS residuals
#include "shared/vertex_normal.glsl"

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (self.exists)
        normals[self.index] = vec4(vertex_normal(self), 0);
}
