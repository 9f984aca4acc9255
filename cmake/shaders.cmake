# voile_add_shaders(TARGET target NAMESPACE name FOLDER folder SHADERS a.comp b.frag ...)
#
# Compiles each shader of `folder` with glslangValidator (includes tracked by a depfile), checks it with spirv-val and
# embeds it: the target gets <target>_shaders.hpp with `extern const std::span<const uint32_t> k_<stem>_<stage>;` in the
# given namespace.
set(VOILE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed_shader.cmake)

function(voile_add_shaders)
    cmake_parse_arguments(ARG "" "TARGET;NAMESPACE;FOLDER;ENVIRONMENT" "SHADERS" ${ARGN})
    if(NOT ARG_ENVIRONMENT)
        set(ARG_ENVIRONMENT vulkan1.2)
    endif()
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
    file(MAKE_DIRECTORY ${generated}/spirv)
    set(declarations "")
    set(names "")
    foreach(shader IN LISTS ARG_SHADERS)
        get_filename_component(name ${shader} NAME)
        string(REPLACE "." "_" symbol ${name})
        set(source ${ARG_FOLDER}/${shader})
        set(spirv ${generated}/spirv/${name}.spv)
        set(cpp ${generated}/${symbol}.cpp)
        add_custom_command(
            OUTPUT ${spirv}
            COMMAND ${GLSLANG_VALIDATOR} --quiet -V --target-env ${ARG_ENVIRONMENT} -I${ARG_FOLDER}
                    $<$<CONFIG:Debug>:-gVS> --depfile ${spirv}.d -o ${spirv} ${source}
            COMMAND ${SPIRV_VAL} --target-env ${ARG_ENVIRONMENT} ${spirv}
            DEPENDS ${source}
            DEPFILE ${spirv}.d
            COMMENT "Compiling shader ${shader}"
            COMMAND_EXPAND_LISTS VERBATIM)
        add_custom_command(
            OUTPUT ${cpp}
            COMMAND ${CMAKE_COMMAND} -DINPUT=${spirv} -DOUTPUT=${cpp} -DNAMESPACE=${ARG_NAMESPACE}
                    -DSYMBOL=k_${symbol} -P ${VOILE_EMBED_SCRIPT}
            DEPENDS ${spirv} ${VOILE_EMBED_SCRIPT}
            COMMAND_EXPAND_LISTS VERBATIM)
        target_sources(${ARG_TARGET} PRIVATE ${cpp})
        set_source_files_properties(${cpp} PROPERTIES SKIP_PRECOMPILE_HEADERS ON) # they include next to nothing
        string(APPEND declarations "extern const std::span<const uint32_t> k_${symbol};\n")
        string(APPEND names "    {\"${name}\", &k_${symbol}},\n")
    endforeach()
    file(GENERATE OUTPUT ${generated}/${ARG_TARGET}_shaders.hpp CONTENT
"// Generated: the SPIR-V of this library's shaders.
#pragma once

#include <cstdint>
#include <span>

namespace ${ARG_NAMESPACE}
{
${declarations}
struct NamedShader
{
    const char* file;
    const std::span<const uint32_t>* code;
};
inline constexpr NamedShader k_all[] = {
${names}};

} // namespace ${ARG_NAMESPACE}
")
    target_include_directories(${ARG_TARGET} PRIVATE ${generated})
endfunction()
