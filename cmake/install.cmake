# The CMake package `voile`: the targets voile::gpu and voile::cloth, and, if they were built, voile::engine and
# voile::cloth_component. It can be moved: it names no folder of this machine.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(VOILE_PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/voile)
set(VOILE_INSTALLED voile_gpu voile_cloth)
set(VOILE_HEADERS modules/gpu/include/ modules/cloth/include/)
set(VOILE_NEEDS_VOLK OFF)
if(VOILE_BUILD_ENGINE)
    list(APPEND VOILE_INSTALLED voile_engine voile_cloth_component)
    list(APPEND VOILE_HEADERS engine/include/ modules/cloth_component/include/)
    if(TARGET volk::volk)
        set(VOILE_NEEDS_VOLK ON)
    endif()
endif()
foreach(target IN LISTS VOILE_INSTALLED)
    string(REPLACE "voile_" "" exported ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${exported})
endforeach()
install(TARGETS ${VOILE_INSTALLED} EXPORT voile_targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY ${VOILE_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(EXPORT voile_targets NAMESPACE voile:: DESTINATION ${VOILE_PACKAGE_FOLDER})

configure_package_config_file(cmake/voile-config.cmake.in ${PROJECT_BINARY_DIR}/voile-config.cmake
                              INSTALL_DESTINATION ${VOILE_PACKAGE_FOLDER})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/voile-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/voile-config.cmake ${PROJECT_BINARY_DIR}/voile-config-version.cmake
        DESTINATION ${VOILE_PACKAGE_FOLDER})
