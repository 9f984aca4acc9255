// The clock of an island (pair_layout.h), as kernels of a pass read it.
//
// The including kernel declares pair_islands[] and push (PairPush).
#ifndef VOILE_CLOCK_GLSL
#define VOILE_CLOCK_GLSL

#include "pairs/fall.glsl"
#include "pairs/island.glsl"
#include "pairs/pair_pass.glsl"
#include "pairs/sweep.glsl"

float clock_at_pass(uint cloth) { return pair_islands[cloth].clocks[pair_pass() & 1u]; }

// s, since lists were made.
float time_at_pass(uint cloth) { return pair_islands[cloth].times[pair_pass() & 1u]; }

// Whether nothing is carried.
bool is_clock_stopped(uint cloth)
{
    const uint pass = pair_islands[island_of(cloth)].stopped;
    return pass != 0 && pair_pass() + 1 - pass < VOILE_PAIR_STOPPED_PASSES;
}

// Of the clock to time until the next pass.
float clock_rate(uint cloth)
{
    if (is_clock_stopped(cloth))
        return 0;
    const float room = uintBitsToFloat(pair_islands[island_of(cloth)].rates[pair_pass() & 1u]);
    return min(room, max(step_input.list_time - clock_at_pass(cloth), 0) / pair_interval());
}

// s^2: gravity times this is how far it carries vertices: since lists were made, and until the next pass if the clock
// runs as fast as time.
float fall_at_pass(uint cloth) { return pair_islands[cloth].falls[pair_pass() & 1u]; }

float fall_until_next(uint cloth)
{
    const float clock = clock_at_pass(cloth);
    return pair_interval() * (clock + 0.5 * min(pair_interval(), max(step_input.list_time - clock, 0)));
}

// m: how far what falls freely is carried beyond what its word says, until the next pass if the clock runs as fast as time.
vec3 free_fall_until_next(uint cloth)
{
    return fall_until_next(cloth) * step_input.gravity + pair_interval() * rounded_off(cloth);
}

// m: how far a vertex is carried in that time, as its frame was when lists were made. `fall`: free_fall_until_next of its
// cloth.
vec3 carry_until_next(uint word, vec3 fall)
{
    return pair_interval() * carry_velocity(word) + falls(word) * fall;
}

// m/s, if the clock runs as fast as time; `lag`: s before the pass. With the mean until the next pass, cloth that falls faster
// than its island counted as slower than it is.
vec3 carry_at_pass(uint word, uint cloth, float lag)
{
    const vec3 fall = rounded_off(cloth) + (clock_at_pass(cloth) - lag) * step_input.gravity;
    return carry_velocity(word) + falls(word) * fall;
}

// Relative to another vertex of the island. What is carried equally has exactly 0, whatever a compiler does with sums.
vec3 carry_until_next(uint word, uint other, vec3 fall)
{
    return word == other ? vec3(0) : carry_until_next(word, fall) - carry_until_next(other, fall);
}

#endif
