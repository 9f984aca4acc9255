// VOILE_API marks what the shared library voile_cloth exports, VOILE_GPU_API what voile_gpu exports. All else is
// hidden. Both are empty in a static build. CMake's targets define VOILE_SHARED for their users, and
// VOILE_CLOTH_EXPORTS or VOILE_GPU_EXPORTS while they are built.
#pragma once

#if !defined(VOILE_SHARED)
#define VOILE_IMPORT
#define VOILE_EXPORT
#elif defined(_WIN32)
#define VOILE_IMPORT __declspec(dllimport)
#define VOILE_EXPORT __declspec(dllexport)
#else
#define VOILE_IMPORT __attribute__((visibility("default")))
#define VOILE_EXPORT __attribute__((visibility("default")))
#endif

#if defined(VOILE_CLOTH_EXPORTS)
#define VOILE_API VOILE_EXPORT
#else
#define VOILE_API VOILE_IMPORT
#endif

#if defined(VOILE_GPU_EXPORTS)
#define VOILE_GPU_API VOILE_EXPORT
#else
#define VOILE_GPU_API VOILE_IMPORT
#endif
