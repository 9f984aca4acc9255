// The lists of a mesh vertex: where its n-th spring and its n-th triangle stand. See MeshVertex.
#ifndef VOILE_MESH_GLSL
#define VOILE_MESH_GLSL

layout(constant_id = 2) const uint INTERLEAVED = 1; // the layout of the lists, cloth::MeshLayout

const uint MESH_STRIDE = INTERLEAVED == 1 ? gl_WorkGroupSize.x : 1;

#endif
