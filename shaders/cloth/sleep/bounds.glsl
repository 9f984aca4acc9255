// The box around the vertices of a workgroup, as ordered numbers that grow.
#ifndef VOILE_SLEEP_BOUNDS_GLSL
#define VOILE_SLEEP_BOUNDS_GLSL

#include "shared/box.glsl"
#include "shared/ordered.glsl"

shared uint shared_low[3]; // inverted
shared uint shared_high[3];

void clear_bounds(uint thread)
{
    if (thread < 3)
        shared_low[thread] = shared_high[thread] = 0;
}

void add_to_bounds(Box box)
{
    for (uint axis = 0; axis < 3; ++axis)
    {
        atomicMax(shared_low[axis], ~ordered(box.min[axis]));
        atomicMax(shared_high[axis], ordered(box.max[axis]));
    }
}

#endif
