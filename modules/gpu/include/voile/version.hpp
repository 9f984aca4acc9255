// The version of the module that these headers belong to. CMake takes the project's version from here.
#pragma once

#define VOILE_VERSION_MAJOR 0
#define VOILE_VERSION_MINOR 1
#define VOILE_VERSION_PATCH 0

// Grows with each version, so that versions compare: VOILE_VERSION >= VOILE_MAKE_VERSION(0, 2, 0).
#define VOILE_MAKE_VERSION(major, minor, patch) ((major)*1000000 + (minor)*1000 + (patch))
#define VOILE_VERSION VOILE_MAKE_VERSION(VOILE_VERSION_MAJOR, VOILE_VERSION_MINOR, VOILE_VERSION_PATCH)

#define VOILE_STRINGIZE_DETAIL(value) #value
#define VOILE_STRINGIZE(value) VOILE_STRINGIZE_DETAIL(value)
#define VOILE_VERSION_STRING                                                                                           \
    VOILE_STRINGIZE(VOILE_VERSION_MAJOR)                                                                               \
    "." VOILE_STRINGIZE(VOILE_VERSION_MINOR) "." VOILE_STRINGIZE(VOILE_VERSION_PATCH)
