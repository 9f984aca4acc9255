# What the renderer is made of.
set(VOILE_RENDER_SHADERS shadow.vert sky.frag sky.vert surface.frag surface.vert)
set(VOILE_RENDER_SOURCES render/frame_bindings.cpp render/graphics_pipeline.cpp render/renderer.cpp)
