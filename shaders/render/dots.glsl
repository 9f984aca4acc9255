// Common to dots: the square around each.
#ifndef VOILE_DOTS_GLSL
#define VOILE_DOTS_GLSL

#include "marks.glsl"

// The corners of the square around a dot, from -1 to 1.
vec2 dot_corner()
{
    return vec2((0x2a >> gl_VertexIndex & 1) != 0 ? 1 : -1, (0x34 >> gl_VertexIndex & 1) != 0 ? 1 : -1);
}

// A corner of the dot's square, push.size pixels wide. Hidden if push.mask is set and `flags` has none of its bits.
vec4 project_dot(vec3 position, uint flags)
{
    if (push.mask != 0 && (flags & push.mask) == 0)
        return vec4(2, 2, 2, 1);
    vec4 result = project_mark(position);
    result.xy += 0.5 * push.size * dot_corner() * push.pixel * result.w;
    return result;
}

#endif
