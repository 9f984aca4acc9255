// The layout of the lists of a mesh vertex. See MeshVertex.
#ifndef VOILE_MESH_GLSL
#define VOILE_MESH_GLSL

#include "shared/patch_size.glsl"

layout(constant_id = k_constant_interleaved) const uint INTERLEAVED = 1; // SolverOptions::mesh_layout

const uint MESH_STRIDE = INTERLEAVED == 1 ? PATCH_SIZE : 1;

#endif
