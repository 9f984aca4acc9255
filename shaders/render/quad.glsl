// Sharing between the four pixels of a square, in fragment shaders.
#ifndef VOILE_QUAD_GLSL
#define VOILE_QUAD_GLSL

// The mean over the square of two by two pixels that share derivatives: their patterns of samples differ, so that it has
// four times as many. Not in divergent control flow.
float quad_mean(float value)
{
    const vec2 toward = 1 - 2 * mod(floor(gl_FragCoord.xy), 2); // the neighbor in the square
    value += 0.5 * toward.x * dFdxFine(value);
    return value + 0.5 * toward.y * dFdyFine(value);
}

#endif
