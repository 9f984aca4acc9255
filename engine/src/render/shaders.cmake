# The shaders of the renderer.
set(VOILE_RENDER_SHADERS dot.vert flagged_dot.vert height.vert line.vert mark.frag overlay.frag overlay.vert
    shadow.vert sky.frag sky.vert surface.frag surface.vert wire.frag)
