voile_add_test(test_assets SOURCES test_obj.cpp test_ply.cpp test_shapes.cpp test_image_file.cpp
               LIBRARIES voile::engine)
voile_add_test(test_bvh SOURCES test_bvh.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_integration SOURCES test_integration.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_viewer_parts
    SOURCES test_scene_file.cpp test_scene_lookup.cpp test_options.cpp test_exports.cpp test_run_files.cpp
    LIBRARIES voile_viewer_parts)
voile_add_test(test_contact SOURCES test_contact.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_scene_meshes SOURCES test_scene_meshes.cpp LIBRARIES voile_scene_meshes voile::engine)
voile_add_test(test_viewer SOURCES test_viewer.cpp LIBRARIES voile_viewer_parts)
add_dependencies(test_viewer viewer scene_meshes)
# Queue-submit validation is switched on by the environment alone; see test_hazards.cpp.
voile_add_test(test_hazards SOURCES test_hazards.cpp LIBRARIES voile::cloth_internal voile::engine
    ENVIRONMENT VK_LAYER_ENABLES=VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT)
voile_add_test(test_renderer SOURCES test_renderer.cpp LIBRARIES voile::cloth_component voile::engine)

# A captured frame, read with RenderDoc's Python module (Debian's, hence its Python).
if(EXISTS /usr/bin/python3)
    add_test(NAME "capture: the frame in RenderDoc"
             COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/check_capture.py $<TARGET_FILE:viewer> reference)
    set_tests_properties("capture: the frame in RenderDoc" PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
endif()
