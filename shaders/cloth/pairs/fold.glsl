// Folds values of all threads of a workgroup: sums, then maxima.
//
// The including kernel defines k_values, their number.
#ifndef VOILE_FOLD_GLSL
#define VOILE_FOLD_GLSL

shared float shared_values[k_values * gl_WorkGroupSize.x];

// In the first thread.
void fold(uint thread, uint sums, inout float values[k_values])
{
    barrier();
    for (uint k = 0; k < k_values; ++k)
        shared_values[k * gl_WorkGroupSize.x + thread] = values[k];
    for (uint width = gl_WorkGroupSize.x / 2; width > 0; width /= 2)
    {
        barrier();
        if (thread >= width)
            continue;
        for (uint k = 0; k < k_values; ++k)
        {
            const float other = shared_values[k * gl_WorkGroupSize.x + thread + width];
            values[k] = k < sums ? values[k] + other : max(values[k], other);
            shared_values[k * gl_WorkGroupSize.x + thread] = values[k];
        }
    }
}

#endif
