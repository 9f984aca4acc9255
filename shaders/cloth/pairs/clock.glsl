// The clock of the lists of pairs (pair_layout.h), as kernels of a pass read it.
//
// The including kernel declares pair_searches[] and push (PairPush).
#ifndef VOILE_CLOCK_GLSL
#define VOILE_CLOCK_GLSL

#include "pairs/fall.glsl"
#include "pairs/pair_pass.glsl"
#include "pairs/sweep.glsl"

float clock_at_pass() { return uintBitsToFloat(pair_searches[VOILE_PAIR_CLOCKS + (pair_pass() & 1u)].entries); }

// Whether nothing is carried.
bool is_clock_stopped()
{
    const uint pass = pair_searches[VOILE_PAIR_STOPPED].entries;
    return pass != 0 && pair_pass() + 1 - pass < VOILE_PAIR_STOPPED_PASSES;
}

// Of the clock to time until the next pass.
float clock_rate()
{
    if (is_clock_stopped())
        return 0;
    const float room = uintBitsToFloat(pair_searches[VOILE_PAIR_RATES + (pair_pass() & 1u)].entries);
    return min(room, max(VOILE_PAIR_SWEEP_TIME - clock_at_pass(), 0) / pair_interval());
}

// s^2: gravity times this is how far it carries vertices: since lists were made, and until the next pass if the clock
// runs as fast as time.
float fall_at_pass() { return uintBitsToFloat(pair_searches[VOILE_PAIR_FALLS + (pair_pass() & 1u)].entries); }

float fall_until_next()
{
    const float clock = clock_at_pass();
    return pair_interval() * (clock + 0.5 * min(pair_interval(), max(VOILE_PAIR_SWEEP_TIME - clock, 0)));
}

// m: how far a vertex is carried until the next pass if the clock runs as fast as time.
vec3 carry_until_next(uint word)
{
    return 2 * pair_interval() / VOILE_PAIR_SWEEP_TIME * unpack_half_sweep(word) +
           falls(word) * (fall_until_next() * step_input.gravity + pair_interval() * rounded_off());
}

// Relative to another vertex. What is carried equally has exactly 0, whatever a compiler does with sums.
vec3 carry_until_next(uint word, uint other)
{
    return word == other ? vec3(0) : carry_until_next(word) - carry_until_next(other);
}

#endif
