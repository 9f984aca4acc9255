// Vertices of meshes without triangles. They have no mass and do not move, and nothing can hang on them.
//
// The including kernel declares cloths[] and mesh_vertices[].
#ifndef VOILE_ISOLATED_GLSL
#define VOILE_ISOLATED_GLSL

bool is_isolated(PatchVertex vertex)
{
    return vertex.columns == 0 && mesh_vertices[cloths[vertex.cloth].first_list + vertex.local].corners == 0;
}

#endif
