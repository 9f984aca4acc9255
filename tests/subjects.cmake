voile_add_test(test_samples SOURCES viewer/test_hello_cloth.cpp viewer/test_samples.cpp LIBRARIES voile::cloth voile::engine)
add_dependencies(test_samples async_compute batch foreign_engine hello_cloth own_component skinned)
voile_add_test(test_assets SOURCES engine/test_files.cpp engine/test_obj.cpp engine/test_save_obj.cpp engine/test_ply.cpp colliders/test_shapes.cpp engine/test_image_file.cpp
               LIBRARIES voile::engine)
voile_add_test(test_bvh SOURCES geometry/test_bvh.cpp geometry/test_self_intersection.cpp colliders/test_bvh_cache.cpp geometry/test_closedness.cpp geometry/test_mesh_parts.cpp geometry/test_parallel.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_model SOURCES model/test_cooked.cpp model/test_limit_levels.cpp model/test_mesh_fans.cpp model/test_mesh_records.cpp model/test_range_allocator.cpp model/test_substep_plan.cpp
                                  colliders/test_cooked_collider.cpp
               LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_sleep SOURCES solver/test_sleep.cpp solver/test_wake.cpp solver/test_awake_patches.cpp pairs/test_sleeping_islands.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_refit SOURCES colliders/test_refit.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_intersections SOURCES intersections/test_cloth_intersections.cpp intersections/test_collider_intersections.cpp support/test_exact_intersections.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_self_collision SOURCES pairs/test_self_collision.cpp pairs/test_pair_lists.cpp pairs/test_hard_cases.cpp pairs/test_squeezed.cpp pairs/test_pair_response.cpp pairs/test_pair_motion.cpp pairs/test_impacts.cpp pairs/test_crowded.cpp pairs/test_near_layers.cpp pairs/test_tangles.cpp pairs/test_islands.cpp pairs/test_waiting.cpp pairs/test_moving_frame.cpp pairs/test_turning_frame.cpp pairs/test_sliding_layers.cpp pairs/test_least_distance.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_shaders(TARGET test_refit NAMESPACE tests::shaders FOLDER ${PROJECT_SOURCE_DIR}/shaders/cloth SHADERS ../../tests/colliders/visit_padded.comp)
voile_add_test(test_integration SOURCES integration/test_integration.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_viewer_parts
    SOURCES viewer/test_scene_file.cpp viewer/test_scene_errors.cpp viewer/test_scene_syntax.cpp viewer/test_options.cpp viewer/test_exports.cpp viewer/test_usd.cpp viewer/test_statistics_file.cpp
            viewer/test_film.cpp viewer/test_shader_compiler.cpp viewer/test_looks.cpp viewer/test_progress.cpp viewer/test_frame_sequence.cpp viewer/test_scene_writer.cpp viewer/test_picking.cpp
    LIBRARIES voile_viewer_parts nlohmann_json::nlohmann_json)
voile_add_test(test_contact SOURCES contact/test_contact.cpp contact/test_swept_contact.cpp contact/test_candidates.cpp contact/test_features.cpp contact/test_feature_selection.cpp contact/test_tuning.cpp contact/test_feature_spacing.cpp contact/test_round_features.cpp contact/test_friction.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_scene_meshes SOURCES viewer/test_scene_meshes.cpp LIBRARIES voile_scene_meshes voile::cloth voile::engine)
voile_add_test(test_viewer
               SOURCES viewer/test_viewer.cpp viewer/test_viewer_solids.cpp viewer/test_viewer_frames.cpp viewer/test_viewer_inputs.cpp viewer/test_viewer_ribbons.cpp
                       viewer/test_signals.cpp viewer/test_viewer_exports.cpp viewer/test_softening_notes.cpp ../samples/viewer/softening_notes.cpp
               LIBRARIES voile_viewer_parts voile_scene_meshes voile::cloth_component)
add_dependencies(test_viewer viewer scene_meshes)
voile_add_test(test_statistics SOURCES statistics/test_statistics.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_mesh_cloth SOURCES forces/test_mesh_cloth.cpp geometry/test_mesh_input.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_membrane SOURCES forces/test_membrane.cpp forces/test_shared_forces.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_verlet SOURCES integration/test_verlet.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_static_friction SOURCES contact/test_static_friction.cpp contact/test_contact_interval.cpp contact/test_ridges.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_energy SOURCES integration/test_energy.cpp integration/test_energy_random.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_stability SOURCES forces/test_stability.cpp forces/test_slivers.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_fabric SOURCES forces/test_fabric.cpp forces/test_air.cpp forces/test_far.cpp contact/test_far_contact.cpp LIBRARIES voile::cloth voile::engine)
if(NOT VOILE_SANITIZE) # it replaces operator new, and so do sanitizers
    voile_add_test(test_frame SOURCES engine/test_frame.cpp ../bench/allocations.cpp LIBRARIES voile::cloth_component voile::engine)
endif()
voile_add_test(test_hazards SOURCES solver/test_hazards.cpp solver/test_recorder.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_renderer SOURCES engine/test_renderer.cpp engine/test_shadows.cpp engine/test_overlay.cpp engine/test_camera_control.cpp LIBRARIES voile::cloth_component voile::engine)

# A captured frame, read with RenderDoc's Python module (Debian's, hence its Python).
if(EXISTS /usr/bin/python3)
    add_test(NAME "capture: the frame in RenderDoc"
             COMMAND /usr/bin/python3 ${CMAKE_CURRENT_SOURCE_DIR}/viewer/check_capture.py $<TARGET_FILE:viewer> reference)
    set_tests_properties("capture: the frame in RenderDoc" PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
endif()

# Baked scenes, read by other programs. VOILE_USD_PYTHON: one that has the package usd-core.
set(VOILE_USD_PYTHON /usr/bin/python3 CACHE FILEPATH "A Python with the package usd-core, for the test of USD files")
if(EXISTS ${VOILE_USD_PYTHON})
    add_test(NAME "bake: USD, OBJ and PC2 agree"
             COMMAND ${VOILE_USD_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/viewer/check_usd.py $<TARGET_FILE:viewer>)
    set_tests_properties("bake: USD, OBJ and PC2 agree" PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 120)
endif()
find_program(BLENDER blender)
if(BLENDER)
    add_test(NAME "bake: Blender reads OBJ and PC2"
             COMMAND ${BLENDER} --background --factory-startup --python-exit-code 1
                     --python ${CMAKE_CURRENT_SOURCE_DIR}/viewer/check_blender.py -- $<TARGET_FILE:viewer>)
else()
    add_test(NAME "bake: Blender reads OBJ and PC2" COMMAND ${CMAKE_COMMAND} -E echo "skipped: Blender is not installed")
endif()
set_tests_properties("bake: Blender reads OBJ and PC2" PROPERTIES SKIP_REGULAR_EXPRESSION "^skipped:" TIMEOUT 120)

# A window with its swapchain, if there is a virtual display.
find_program(XVFB_RUN xvfb-run)
if(XVFB_RUN)
    add_test(NAME "window: frames on a virtual display"
             COMMAND ${XVFB_RUN} -a $<TARGET_FILE:viewer> reference --frames 10 --validate --cloth-resolution 16
                     --size 320x180)
    set_tests_properties("window: frames on a virtual display" PROPERTIES TIMEOUT 120)
endif()

# The window as its users use it: keys and mouse by the XTEST extension.
find_program(XVFB Xvfb)
find_package(X11 QUIET)
if(XVFB AND X11_FOUND AND X11_XTest_FOUND)
    voile_add_test(test_window SOURCES viewer/test_window.cpp viewer/test_window_shaders.cpp viewer/x_display.cpp
                   LIBRARIES voile_viewer_parts voile::engine X11::X11 X11::Xtst)
    target_compile_definitions(test_window PRIVATE VOILE_HAS_PANEL=$<BOOL:${ImGui_FOUND}>)
    add_dependencies(test_window viewer scene_meshes)
endif()

# A separate project that uses the installed package.
set(consumer_linker_flags ${CMAKE_EXE_LINKER_FLAGS})
if(VOILE_SANITIZE)
    set(consumer_linker_flags -fsanitize=${VOILE_SANITIZE})
endif()
set(consumer_options "-DCMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER}")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU") # as the project's own sources
    list(APPEND consumer_options "-DCMAKE_CXX_FLAGS=--param=ggc-min-heapsize=1048576")
endif()
set(consumer_prefix ${CMAKE_CURRENT_BINARY_DIR}/prefix)
add_test(NAME "consumer: clean" COMMAND ${CMAKE_COMMAND} -E rm -rf ${consumer_prefix} ${consumer_prefix}_before)
add_test(NAME "consumer: install"
         COMMAND ${CMAKE_COMMAND} --install ${CMAKE_BINARY_DIR} --prefix ${consumer_prefix}_before)
add_test(NAME "consumer: move" COMMAND ${CMAKE_COMMAND} -E rename ${consumer_prefix}_before ${consumer_prefix})
add_test(NAME "consumer: the package names no folder and has its license"
         COMMAND ${CMAKE_COMMAND} -DPREFIX=${consumer_prefix} -DSOURCE=${PROJECT_SOURCE_DIR} -DBUILD=${CMAKE_BINARY_DIR}
                 -P ${CMAKE_CURRENT_SOURCE_DIR}/check_package.cmake)
add_test(NAME "consumer: find_package"
         COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer
                 ${CMAKE_CURRENT_BINARY_DIR}/consumer --build-generator ${CMAKE_GENERATOR}
                 --build-options -DCMAKE_PREFIX_PATH=${consumer_prefix} "-DCMAKE_EXE_LINKER_FLAGS=${consumer_linker_flags}"
                                 ${consumer_options}
                 --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
set_tests_properties("consumer: clean" PROPERTIES FIXTURES_SETUP installed)
set_tests_properties("consumer: install" PROPERTIES FIXTURES_SETUP installed DEPENDS "consumer: clean")
set_tests_properties("consumer: move" PROPERTIES FIXTURES_SETUP installed DEPENDS "consumer: install")
set_tests_properties("consumer: the package names no folder and has its license" PROPERTIES FIXTURES_REQUIRED installed)
set_tests_properties("consumer: find_package" PROPERTIES FIXTURES_REQUIRED installed)
add_test(NAME "consumer: add_subdirectory"
         COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer/subdirectory
                 ${CMAKE_CURRENT_BINARY_DIR}/subdirectory_consumer --build-generator ${CMAKE_GENERATOR}
                 --build-options ${consumer_options}
                 --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
# They take long and use one core each, so they begin first.
set_tests_properties("consumer: find_package" "consumer: add_subdirectory" PROPERTIES
    TIMEOUT 900 COST 1000 ENVIRONMENT CMAKE_BUILD_PARALLEL_LEVEL=1)

# The sample of the guide, with validation and synchronization validation, which print what they find.
add_test(NAME "foreign_engine: a sheet falls on a ball" COMMAND foreign_engine ${CMAKE_CURRENT_BINARY_DIR}/sheet.ply)
add_test(NAME "async_compute: each frame is drawn from its own vertices" COMMAND async_compute)
set_tests_properties("foreign_engine: a sheet falls on a ball" PROPERTIES PASS_REGULAR_EXPRESSION "are inside[\r\n]+wrote ")
set_tests_properties("async_compute: each frame is drawn from its own vertices" PROPERTIES
    PASS_REGULAR_EXPRESSION "every frame was drawn from its own vertices")
set_tests_properties("foreign_engine: a sheet falls on a ball" "async_compute: each frame is drawn from its own vertices" PROPERTIES
    TIMEOUT 300 FAIL_REGULAR_EXPRESSION "VUID|SYNC-|alidation Error"
    ENVIRONMENT "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation;VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT")
add_test(NAME "integration: the guide shows the program of foreign_engine"
         COMMAND ${CMAKE_COMMAND} -DFOLDER=${CMAKE_CURRENT_BINARY_DIR}/guide_project
                 -P ${CMAKE_CURRENT_SOURCE_DIR}/check_integration.cmake)
find_program(DOXYGEN doxygen)
if(DOXYGEN)
    file(MAKE_DIRECTORY ${PROJECT_SOURCE_DIR}/build/reference)
    add_test(NAME "reference: Doxygen has no warning" COMMAND ${DOXYGEN} docs/Doxyfile WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
endif()
add_test(NAME "recipes: vcpkg and Conan"
         COMMAND ${CMAKE_COMMAND} -DVERSION=${PROJECT_VERSION} -P ${CMAKE_CURRENT_SOURCE_DIR}/check_recipes.cmake)
voile_add_test(test_attachments SOURCES constraints/test_attachments.cpp constraints/test_springs.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_edits SOURCES solver/test_edits.cpp solver/test_teleport.cpp constraints/test_strain_limit.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_moving_colliders SOURCES colliders/test_moving_colliders.cpp colliders/test_many_colliders.cpp colliders/test_deforming_colliders.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_hard_contacts SOURCES contact/test_hard_contacts.cpp contact/test_fast_colliders.cpp contact/test_limited_contact.cpp contact/test_round_colliders.cpp forces/test_softened.cpp support/shots.cpp colliders/test_odd_colliders.cpp colliders/test_spinning_collider.cpp support/test_crossing_checks.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_lifetime SOURCES solver/test_uploads.cpp solver/test_removal.cpp solver/test_random_changes.cpp solver/test_collider_changes.cpp solver/test_substeps.cpp solver/test_ids.cpp solver/test_limits.cpp solver/test_bindings.cpp solver/test_texel_reads.cpp solver/buffer_table.cpp solver/test_ranges.cpp solver/test_lifetime.cpp solver/test_old_memory.cpp solver/test_scopes.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_shaders(TARGET test_lifetime NAMESPACE tests::shaders FOLDER ${CMAKE_CURRENT_SOURCE_DIR}
                  SHADERS solver/read_texels.comp solver/narrow_index.comp solver/buffer_array.comp solver/large_workgroup.comp solver/no_compute.vert)
add_library(test_old_shaders STATIC)
voile_add_shaders(TARGET test_old_shaders NAMESPACE tests::old_shaders FOLDER ${CMAKE_CURRENT_SOURCE_DIR} ENVIRONMENT vulkan1.0
                  SHADERS solver/double_words.comp)
add_library(test_new_shaders STATIC)
voile_add_shaders(TARGET test_new_shaders NAMESPACE tests::new_shaders FOLDER ${CMAKE_CURRENT_SOURCE_DIR} ENVIRONMENT vulkan1.3
                  SHADERS solver/sized_workgroup.comp)
target_link_libraries(test_lifetime PRIVATE test_old_shaders test_new_shaders)
voile_add_test(test_depenetration SOURCES contact/test_solids.cpp contact/test_inside.cpp contact/test_pinch.cpp contact/test_depenetration.cpp contact/test_separate_solids.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_command_reuse SOURCES solver/test_command_reuse.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_output SOURCES solver/test_output.cpp solver/test_previous_positions.cpp solver/test_vertex_streams.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_softened_limit SOURCES constraints/test_softened_limit.cpp constraints/test_softened_meshes.cpp constraints/test_step_lengths.cpp constraints/test_shaking.cpp constraints/test_budget_motion.cpp LIBRARIES voile::cloth_internal voile::engine voile_scene_meshes)

# The benchmark's files of results, and its options for them.
if(TARGET cloth_bench)
    voile_add_test(test_bench SOURCES bench/test_bench.cpp LIBRARIES voile_bench_results)
    set(results ${PROJECT_SOURCE_DIR}/bench/results)
    add_test(NAME "cloth_bench: --compare shows both devices"
             COMMAND cloth_bench --compare ${results}/lavapipe-2-cores.csv ${results}/nvidia-h200.csv)
    set_tests_properties("cloth_bench: --compare shows both devices" PROPERTIES
                         PASS_REGULAR_EXPRESSION "A  llvmpipe.*B  NVIDIA H200.*grid-128 .*faster")
    add_test(NAME "cloth_bench: --compare names a missing file"
             COMMAND cloth_bench --compare ${results}/lavapipe-2-cores.csv nosuch.csv)
    set_tests_properties("cloth_bench: --compare names a missing file" PROPERTIES
                         PASS_REGULAR_EXPRESSION "^cloth_bench: nosuch.csv: cannot be read")
    add_test(NAME "cloth_bench: --plot needs results" COMMAND cloth_bench --plot plot.svg)
    set_tests_properties("cloth_bench: --plot needs results" PROPERTIES
                         PASS_REGULAR_EXPRESSION "^cloth_bench: --plot requires --results")
    add_test(NAME "cloth_bench: --peers says how they were measured" COMMAND cloth_bench --peers)
    set_tests_properties("cloth_bench: --peers says how they were measured" PROPERTIES
                         PASS_REGULAR_EXPRESSION "How they were taken")
endif()

# Subjects that start programs: those make pipelines when they are first bound (support/late_pipelines.cpp).
set(starting_programs test_viewer test_samples)
if(TARGET test_window)
    list(APPEND starting_programs test_window)
endif()
if(UNIX AND NOT APPLE)
    add_library(late_pipelines MODULE support/late_pipelines.cpp)
    target_link_libraries(late_pipelines PRIVATE voile_options Vulkan::Headers)
    set(layers ${CMAKE_CURRENT_BINARY_DIR}/layers)
    set_target_properties(late_pipelines PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${layers} CXX_VISIBILITY_PRESET hidden)
    file(GENERATE OUTPUT ${layers}/late_pipelines.json CONTENT
"{ \"file_format_version\": \"1.2.0\", \"layer\": { \"name\": \"VK_LAYER_VOILE_late_pipelines\", \"type\": \"GLOBAL\",
  \"library_path\": \"./$<TARGET_FILE_NAME:late_pipelines>\", \"api_version\": \"1.3.0\", \"implementation_version\": \"1\",
  \"description\": \"Makes compute pipelines when they are first bound\" } }
")
    foreach(subject IN LISTS starting_programs)
        add_dependencies(${subject} late_pipelines)
    endforeach()
    # The hosts of the module, too. "foreign_engine: a sheet falls on a ball" makes all pipelines in advance.
    set_tests_properties("async_compute: each frame is drawn from its own vertices" PROPERTIES ENVIRONMENT
        "VK_ADD_LAYER_PATH=${layers};VK_INSTANCE_LAYERS=VK_LAYER_VOILE_late_pipelines:VK_LAYER_KHRONOS_validation;VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT")
    set_property(TEST "consumer: find_package" "consumer: add_subdirectory" APPEND PROPERTY ENVIRONMENT
        VK_ADD_LAYER_PATH=${layers} VK_INSTANCE_LAYERS=VK_LAYER_VOILE_late_pipelines)
    set(by_viewer "bake: Blender reads OBJ and PC2")
    if(EXISTS ${VOILE_USD_PYTHON})
        list(APPEND by_viewer "bake: USD, OBJ and PC2 agree")
    endif()
    if(XVFB_RUN)
        list(APPEND by_viewer "window: frames on a virtual display")
    endif()
    set_property(TEST ${by_viewer} APPEND PROPERTY ENVIRONMENT
        VK_ADD_LAYER_PATH=${layers} VK_INSTANCE_LAYERS=VK_LAYER_VOILE_late_pipelines)
endif()
