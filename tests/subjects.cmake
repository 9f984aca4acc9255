voile_add_test(test_hello_cloth SOURCES test_hello_cloth.cpp LIBRARIES voile::engine)
add_dependencies(test_hello_cloth hello_cloth)
voile_add_test(test_assets SOURCES test_files.cpp test_obj.cpp test_ply.cpp test_shapes.cpp test_image_file.cpp
               LIBRARIES voile::engine)
voile_add_test(test_bvh SOURCES test_bvh.cpp test_bvh_cache.cpp test_closedness.cpp test_mesh_parts.cpp test_parallel.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_refit SOURCES test_refit.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_shaders(TARGET test_refit NAMESPACE tests::shaders FOLDER ${CMAKE_CURRENT_SOURCE_DIR} SHADERS visit_padded.comp)
voile_add_test(test_integration SOURCES test_integration.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_viewer_parts
    SOURCES test_scene_file.cpp test_scene_errors.cpp test_options.cpp test_exports.cpp test_statistics_file.cpp
            test_film.cpp test_progress.cpp test_frame_sequence.cpp
    LIBRARIES voile_viewer_parts nlohmann_json::nlohmann_json)
voile_add_test(test_contact SOURCES test_contact.cpp test_swept_contact.cpp test_candidates.cpp test_features.cpp test_friction.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_scene_meshes SOURCES test_scene_meshes.cpp LIBRARIES voile_scene_meshes voile::engine)
voile_add_test(test_viewer
               SOURCES test_viewer.cpp test_viewer_solids.cpp test_viewer_frames.cpp test_viewer_inputs.cpp
                       test_signals.cpp test_softening_notes.cpp ../samples/viewer/softening_notes.cpp
               LIBRARIES voile_viewer_parts voile_scene_meshes voile::cloth_component)
add_dependencies(test_viewer viewer scene_meshes)
voile_add_test(test_statistics SOURCES test_statistics.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_mesh_cloth SOURCES test_mesh_cloth.cpp test_mesh_input.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_membrane SOURCES test_membrane.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_verlet SOURCES test_verlet.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_static_friction SOURCES test_static_friction.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_energy SOURCES test_energy.cpp test_energy_random.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_stability SOURCES test_stability.cpp test_slivers.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_fabric SOURCES test_fabric.cpp test_air.cpp test_far.cpp test_far_contact.cpp LIBRARIES voile::cloth voile::engine)
if(NOT VOILE_SANITIZE) # it replaces operator new, and so do sanitizers
    voile_add_test(test_frame SOURCES test_frame.cpp ../bench/allocations.cpp LIBRARIES voile::cloth_component voile::engine)
endif()
voile_add_test(test_hazards SOURCES test_hazards.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_renderer SOURCES test_renderer.cpp LIBRARIES voile::cloth_component voile::engine)

# A captured frame, read with RenderDoc's Python module (Debian's, hence its Python).
if(EXISTS /usr/bin/python3)
    add_test(NAME "capture: the frame in RenderDoc"
             COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/check_capture.py $<TARGET_FILE:viewer> reference)
    set_tests_properties("capture: the frame in RenderDoc" PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
endif()

# A window with its swapchain, where there is a virtual display to open it on.
find_program(XVFB_RUN xvfb-run)
if(XVFB_RUN)
    add_test(NAME "window: frames on a virtual display"
             COMMAND ${XVFB_RUN} -a $<TARGET_FILE:viewer> reference --frames 10 --validate --cloth-resolution 16
                     --size 320x180)
    set_tests_properties("window: frames on a virtual display" PROPERTIES TIMEOUT 120)
endif()

# The installed package, used by a project of its own.
set(consumer_linker_flags ${CMAKE_EXE_LINKER_FLAGS})
if(VOILE_SANITIZE)
    set(consumer_linker_flags -fsanitize=${VOILE_SANITIZE})
endif()
set(consumer_prefix ${CMAKE_CURRENT_BINARY_DIR}/prefix)
add_test(NAME "consumer: install" COMMAND ${CMAKE_COMMAND} --install ${CMAKE_BINARY_DIR} --prefix ${consumer_prefix})
add_test(NAME "consumer: find_package"
         COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer
                 ${CMAKE_CURRENT_BINARY_DIR}/consumer --build-generator ${CMAKE_GENERATOR}
                 --build-options -DCMAKE_PREFIX_PATH=${consumer_prefix} "-DCMAKE_EXE_LINKER_FLAGS=${consumer_linker_flags}"
                 --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
set_tests_properties("consumer: install" PROPERTIES FIXTURES_SETUP installed)
set_tests_properties("consumer: find_package" PROPERTIES FIXTURES_REQUIRED installed TIMEOUT 300)
voile_add_test(test_holds SOURCES test_holds.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_edits SOURCES test_edits.cpp test_strain_limit.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_moving_colliders SOURCES test_moving_colliders.cpp test_many_colliders.cpp test_deforming_colliders.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_hard_contacts SOURCES test_hard_contacts.cpp test_softened.cpp shots.cpp test_odd_colliders.cpp test_spinning_collider.cpp test_crossing_checks.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_lifetime SOURCES test_uploads.cpp test_ids.cpp test_limits.cpp test_ranges.cpp test_lifetime.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_recovery SOURCES test_recovery.cpp test_depenetration.cpp LIBRARIES voile::cloth voile::engine)
