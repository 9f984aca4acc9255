// The number of vertices of a patch: that of the workgroup's threads, or a part of it where several threads share the
// forces of a vertex (mesh_forces.glsl), or where more threads than vertices work on the levels of the strain limit
// (limit_coarse.comp).
#ifndef VOILE_PATCH_SIZE_GLSL
#define VOILE_PATCH_SIZE_GLSL

#if defined(VOILE_SHARES_FORCES) || defined(VOILE_SHARES_LEVELS)
layout(constant_id = k_constant_force_threads) const uint FORCE_THREADS = 1; // per vertex
const uint PATCH_SIZE = gl_WorkGroupSize.x / FORCE_THREADS;
#else
const uint PATCH_SIZE = gl_WorkGroupSize.x;
#endif

#endif
