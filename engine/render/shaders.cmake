# What the renderer is made of.
set(VOILE_RENDER_SHADERS dot.vert line.vert mark.frag shadow.vert sky.frag sky.vert surface.frag surface.vert)
set(VOILE_RENDER_SOURCES render/frame_bindings.cpp render/graphics_pipeline.cpp render/pass_view.cpp render/renderer.cpp)
