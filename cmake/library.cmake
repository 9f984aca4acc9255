# voile_add_library(name EXPORTS macro SOURCES ...)
#
# A library of the module: static, or shared where BUILD_SHARED_LIBS says so. Only what is marked in its headers is visible
# outside (voile/export.hpp); `macro` is defined while it is built.
function(voile_add_library name)
    cmake_parse_arguments(ARG "" "EXPORTS" "SOURCES" ${ARGN})
    add_library(${name} ${ARG_SOURCES})
    string(REPLACE "voile_" "voile::" alias ${name})
    add_library(${alias} ALIAS ${name})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
                                              $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_compile_features(${name} PUBLIC cxx_std_20)
    target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:voile_options>)
    set_target_properties(${name} PROPERTIES
        CXX_VISIBILITY_PRESET hidden
        VISIBILITY_INLINES_HIDDEN ON
        UNITY_BUILD_BATCH_SIZE 8 # larger batches of a host would repeat names of unnamed namespaces
        VERSION ${PROJECT_VERSION}
        SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
        INSTALL_RPATH $<IF:$<PLATFORM_ID:Darwin>,@loader_path,$ORIGIN>)
    if(BUILD_SHARED_LIBS)
        target_compile_definitions(${name} PUBLIC VOILE_SHARED PRIVATE ${ARG_EXPORTS})
        if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT VOILE_SANITIZE)
            target_link_options(${name} PRIVATE LINKER:--no-undefined)
        endif()
    endif()
endfunction()
