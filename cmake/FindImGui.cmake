# Finds Dear ImGui as Debian packages it: a static library with its headers in include/imgui. Target: ImGui::ImGui.
# Distributions with a CMake config of their own have the target imgui::imgui, which is used where it exists.
find_package(imgui CONFIG QUIET)
if(TARGET imgui::imgui)
    set(ImGui_FOUND TRUE)
    if(NOT TARGET ImGui::ImGui)
        add_library(ImGui::ImGui INTERFACE IMPORTED)
        set_target_properties(ImGui::ImGui PROPERTIES INTERFACE_LINK_LIBRARIES imgui::imgui)
    endif()
    return()
endif()
find_path(ImGui_INCLUDE_DIR NAMES imgui.h PATH_SUFFIXES imgui)
find_library(ImGui_LIBRARY NAMES imgui)
find_library(ImGui_STB_LIBRARY NAMES stb) # Debian builds it without its own copy of stb
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(ImGui REQUIRED_VARS ImGui_LIBRARY ImGui_INCLUDE_DIR)
mark_as_advanced(ImGui_INCLUDE_DIR ImGui_LIBRARY ImGui_STB_LIBRARY)
if(ImGui_FOUND AND NOT TARGET ImGui::ImGui)
    add_library(ImGui::ImGui UNKNOWN IMPORTED)
    set_target_properties(ImGui::ImGui PROPERTIES IMPORTED_LOCATION "${ImGui_LIBRARY}"
                          INTERFACE_INCLUDE_DIRECTORIES "${ImGui_INCLUDE_DIR}"
                          INTERFACE_LINK_LIBRARIES "$<$<BOOL:${ImGui_STB_LIBRARY}>:${ImGui_STB_LIBRARY}>")
endif()
