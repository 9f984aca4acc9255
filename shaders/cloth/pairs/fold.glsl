// Folds values of all threads of a workgroup: sums, then maxima.
//
// The including kernel defines k_values, their number.
#ifndef VOILE_FOLD_GLSL
#define VOILE_FOLD_GLSL

shared float shared_values[k_values * gl_WorkGroupSize.x];

// Of one value: every `stride`-th from `first` on, of `count`, into the first of them.
void fold_column(uint value, bool is_sum, uint first, uint stride, uint count)
{
    const uint column = value * gl_WorkGroupSize.x;
    float folded = shared_values[column + first];
    for (uint k = first + stride; k < count; k += stride)
    {
        const float other = shared_values[column + k];
        folded = is_sum ? folded + other : max(folded, other);
    }
    shared_values[column + first] = folded;
}

// In the first thread. Threads take a part of a value each, then a value each: by halves, all would take all values in each
// round, which CPU devices execute for those that have nothing left, too.
void fold(uint thread, uint sums, inout float values[k_values])
{
    const uint parts = max(gl_WorkGroupSize.x / k_values, 1);
    barrier();
    for (uint k = 0; k < k_values; ++k)
        shared_values[k * gl_WorkGroupSize.x + thread] = values[k];
    barrier();
    for (uint k = thread; k < parts * k_values; k += gl_WorkGroupSize.x)
        fold_column(k / parts, k / parts < sums, k % parts, parts, gl_WorkGroupSize.x);
    barrier();
    for (uint k = thread; k < k_values; k += gl_WorkGroupSize.x)
        fold_column(k, k < sums, 0, 1, parts);
    barrier();
    const uint taken = thread == 0 ? k_values : 0;
    for (uint k = 0; k < taken; ++k)
        values[k] = shared_values[k * gl_WorkGroupSize.x];
}

#endif
