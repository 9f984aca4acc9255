// The clock of the lists of pairs (pair_layout.h), as kernels of a pass read it.
//
// The including kernel declares pair_searches[] and push.
#ifndef VOILE_CLOCK_GLSL
#define VOILE_CLOCK_GLSL

#include "pairs/sweep.glsl"

float clock_at_pass() { return uintBitsToFloat(pair_searches[VOILE_PAIR_CLOCKS + (push.pass & 1u)].entries); }

// Whether nothing is carried.
bool is_clock_stopped()
{
    const uint pass = pair_searches[VOILE_PAIR_STOPPED].entries;
    return pass != 0 && push.pass + 1 - pass < VOILE_PAIR_STOPPED_PASSES;
}

// Of the clock to time until the next pass.
float clock_rate()
{
    if (is_clock_stopped())
        return 0;
    const float room = uintBitsToFloat(pair_searches[VOILE_PAIR_RATES + (push.pass & 1u)].entries);
    return min(room, max(VOILE_PAIR_SWEEP_TIME - clock_at_pass(), 0) / push.interval);
}

// m: how far a vertex is carried until the next pass if the clock runs as fast as time.
vec3 carry_until_next(uint word)
{
    return 2 * push.interval / VOILE_PAIR_SWEEP_TIME * unpack_half_sweep(word);
}

#endif
