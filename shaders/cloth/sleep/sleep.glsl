// Whether a cloth sleeps.
//
// The including kernel declares cloths[] and sleeps[].
#ifndef VOILE_SLEEP_GLSL
#define VOILE_SLEEP_GLSL

#include "shared/sleep_layout.h"

// In thicknesses, or ranges of pairs: the least distance of what moves from a cloth that sleeps.
const float k_wake_room = 2;

// Sums of durations are rounded.
bool is_long(float calm) { return calm >= 0.9999 * VOILE_SLEEP_TIME; }

// Of the last step in which cloths were near. A snapshot may have any number.
uint island_of_sleep(uint cloth) { return min(sleeps[cloth].island, sleeps.length() - 1); }

// Cloths of an island sleep if all of them have been calm for long enough.
bool is_asleep(uint cloth)
{
    return cloths[cloth].sleep_speed > 0 && is_long(sleeps[cloth].calm) && sleeps[island_of_sleep(cloth)].restless == 0;
}

bool is_first_patch(Patch self) { return self.first == 0 && self.row == 0; }

#endif
