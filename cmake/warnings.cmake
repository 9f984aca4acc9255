# voile_options: the compiler options of every target of the project. Interface only. Users do not inherit them.
add_library(voile_options INTERFACE)
target_compile_options(voile_options INTERFACE -Wall -Wextra -Wconversion -Wshadow)
if(VOILE_WERROR)
    target_compile_options(voile_options INTERFACE -Werror)
endif()
if(VOILE_SANITIZE)
    target_compile_options(voile_options INTERFACE -fsanitize=${VOILE_SANITIZE} -fno-omit-frame-pointer
                                                   -fno-sanitize-recover=undefined)
    target_link_options(voile_options INTERFACE -fsanitize=${VOILE_SANITIZE})
endif()
