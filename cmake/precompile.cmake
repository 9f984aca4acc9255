# Precompiled headers, which save about a third of the time to compile the project, and batches of sources (unity builds),
# which save two fifths of what then remains for the libraries, the viewer and the benchmark. They hide missing includes, so
# the preset `dev` builds without. Off by default where a launcher such as ccache keeps objects, which it rarely can with
# them, and for a host that adds the module to its own build.
set(voile_precompiles OFF)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED ENV{CMAKE_CXX_COMPILER_LAUNCHER})
    set(voile_precompiles ON)
endif()
option(VOILE_PRECOMPILE_HEADERS "Precompile headers, and compile sources in batches" ${voile_precompiles})
if(VOILE_PRECOMPILE_HEADERS)
    set(CMAKE_UNITY_BUILD ON)
    # In a batch each source is an include, and GCC warns of types of its anonymous namespace as if others could include it.
    add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()

# voile_precompile(target [header ...]): what most sources include, and other headers, for the target's sources in C++
function(voile_precompile target)
    if(VOILE_PRECOMPILE_HEADERS)
        set(headers <vulkan/vulkan.h> <glm/glm.hpp> <glm/gtc/matrix_transform.hpp> <algorithm> <array> <cmath> <functional>
            <map> <memory> <numeric> <optional> <span> <string> <utility> <variant> <vector> ${ARGN})
        list(TRANSFORM headers REPLACE "^<(.*)>$" "$<$<COMPILE_LANGUAGE:CXX>:<\\1$<ANGLE-R>>") # not of volk.c
        target_precompile_headers(${target} PRIVATE ${headers})
    endif()
endfunction()
