# The CMake package `voile`: the targets voile::gpu and voile::cloth, and, if they were built, voile::engine and
# voile::cloth_component.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(VOILE_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/voile)
set(VOILE_INSTALLED voile_gpu voile_cloth)
set(VOILE_HEADERS modules/gpu/include/ modules/cloth/include/)
# Targets that were made here, because the distribution has no CMake config for them, are installed too.
foreach(made voile_volk voile_vma)
    set(${made}_MADE OFF)
    if(TARGET ${made})
        set(${made}_MADE ON)
        list(APPEND VOILE_INSTALLED ${made})
    endif()
endforeach()
if(VOILE_BUILD_ENGINE)
    list(APPEND VOILE_INSTALLED voile_engine voile_cloth_component)
    list(APPEND VOILE_HEADERS engine/include/ modules/cloth_component/include/)
endif()
foreach(target IN LISTS VOILE_INSTALLED)
    string(REPLACE "voile_" "" exported ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${exported})
endforeach()
install(TARGETS ${VOILE_INSTALLED} EXPORT voile_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${VOILE_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT voile_targets NAMESPACE voile:: DESTINATION ${VOILE_PACKAGE_FOLDER})

configure_package_config_file(cmake/voile-config.cmake.in ${CMAKE_BINARY_DIR}/voile-config.cmake
                              INSTALL_DESTINATION ${VOILE_PACKAGE_FOLDER})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/voile-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/voile-config.cmake ${CMAKE_BINARY_DIR}/voile-config-version.cmake
        DESTINATION ${VOILE_PACKAGE_FOLDER})
