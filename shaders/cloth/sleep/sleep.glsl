// Whether a cloth sleeps.
//
// The including kernel declares cloths[] and sleeps[].
#ifndef VOILE_SLEEP_GLSL
#define VOILE_SLEEP_GLSL

#include "shared/sleep_layout.h"

// Sums of durations are rounded.
bool is_long(float calm) { return calm >= 0.9999 * VOILE_SLEEP_TIME; }

// At the end of the last step. Cloths of an island sleep if all of them have been calm for long enough.
bool is_asleep(uint cloth)
{
    const uint island = min(sleeps[cloth].island, sleeps.length() - 1); // a snapshot may have any number
    return cloths[cloth].sleep_speed > 0 && is_long(sleeps[cloth].calm) && sleeps[island].restless == 0;
}

#endif
