// Sums over a cloth from another origin.
#ifndef VOILE_FRAME_SHIFT_GLSL
#define VOILE_FRAME_SHIFT_GLSL

#include "pairs/frame_sums.glsl"

void put(inout float sums[VOILE_FRAME_SUMS], uint first, vec3 value)
{
    for (uint k = 0; k < 3; ++k)
        sums[first + k] = value[k];
}

void put(inout float sums[VOILE_FRAME_SUMS], uint first, mat3 value)
{
    put(sums, first, diagonal_of(value));
    put(sums, first + 3, beside_of(value));
}

// With r + s instead of r: then m + s x n is in place of m.
void shift(inout float sums[VOILE_FRAME_SUMS], vec3 s, uint vertices)
{
    const mat3 lever = cross_matrix(s);
    const mat3 directions = symmetric_from(sums, VOILE_FRAME_DIRECTIONS);
    const mat3 mixed = matrix_from(sums, VOILE_FRAME_MIXED);
    const mat3 across = lever * mixed;
    const mat3 turns = symmetric_from(sums, VOILE_FRAME_TURNS) + across + transpose(across) +
                       lever * directions * transpose(lever);
    put(sums, VOILE_FRAME_TURNS, turns);
    const mat3 shifted = mixed + directions * transpose(lever);
    for (uint k = 0; k < 3; ++k)
        put(sums, VOILE_FRAME_MIXED + 3 * k, shifted[k]);
    put(sums, VOILE_FRAME_MOMENTS,
        sums_from(sums, VOILE_FRAME_MOMENTS) + lever * sums_from(sums, VOILE_FRAME_DRIVES));
    const vec3 positions = sums_from(sums, VOILE_FRAME_POSITIONS);
    const float count = float(vertices);
    put(sums, VOILE_FRAME_SPREADS,
        symmetric_from(sums, VOILE_FRAME_SPREADS) + outerProduct(positions, s) + outerProduct(s, positions) +
            count * outerProduct(s, s));
    put(sums, VOILE_FRAME_POSITIONS, positions + count * s);
    put(sums, VOILE_FRAME_SPINS,
        sums_from(sums, VOILE_FRAME_SPINS) + cross(s, sums_from(sums, VOILE_FRAME_VELOCITIES)));
}

#endif
