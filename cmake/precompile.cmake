# Precompiled headers of the tests, which save about a fifth of the time to compile them. They hide missing includes, so the preset
# `dev` builds without. Off by default where a launcher such as ccache keeps objects, which it rarely can with them.
set(voile_precompiles OFF)
if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER AND NOT DEFINED ENV{CMAKE_CXX_COMPILER_LAUNCHER})
    set(voile_precompiles ON)
endif()
option(VOILE_PRECOMPILE_HEADERS "Precompile headers for the tests" ${voile_precompiles})

# voile_precompile(target [header ...]): what nearly every test includes, and other headers
function(voile_precompile target)
    if(VOILE_PRECOMPILE_HEADERS)
        target_precompile_headers(${target} PRIVATE
            <voile/cloth.hpp> <glm/glm.hpp> <glm/gtc/matrix_transform.hpp> <algorithm> <array> <cmath> <filesystem> <fstream>
            <functional> <map> <memory> <optional> <random> <span> <sstream> <string> <utility> <vector> ${ARGN})
    endif()
endfunction()
