voile_add_test(test_assets SOURCES test_obj.cpp test_image_file.cpp LIBRARIES voile::engine)
voile_add_test(test_bvh SOURCES test_bvh.cpp LIBRARIES voile::cloth_internal voile::engine)
voile_add_test(test_integration SOURCES test_integration.cpp LIBRARIES voile::cloth voile::engine)
voile_add_test(test_viewer_parts SOURCES test_scene_file.cpp test_options.cpp test_exports.cpp LIBRARIES voile_viewer_parts)
