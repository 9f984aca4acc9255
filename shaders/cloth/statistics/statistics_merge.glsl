// Reduction of statistics within a workgroup whose size is a power of two. The order of the sums is fixed.
#ifndef VOILE_STATISTICS_MERGE_GLSL
#define VOILE_STATISTICS_MERGE_GLSL

shared StatisticsRecord partial[gl_WorkGroupSize.x];

StatisticsRecord no_statistics() { return StatisticsRecord(-1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0); } // -1: all springs shrunk to a point

StatisticsRecord merge(StatisticsRecord a, StatisticsRecord b)
{
    a.max_stretch = max(a.max_stretch, b.max_stretch);
    a.stretch_sum += b.stretch_sum;
    a.kinetic_energy += b.kinetic_energy;
    a.deepest_penetration = max(a.deepest_penetration, b.deepest_penetration);
    a.springs += b.springs;
    a.nan_vertices += b.nan_vertices;
    a.penetrating_vertices += b.penetrating_vertices;
    a.contacts += b.contacts;
    a.candidates += b.candidates;
    a.overflowing_vertices += b.overflowing_vertices;
    a.sleeping_cloths += b.sleeping_cloths;
    return a;
}

// The merged statistics of all threads, valid in thread 0.
StatisticsRecord merge_workgroup(StatisticsRecord mine)
{
    const uint thread = gl_LocalInvocationID.x;
    partial[thread] = mine;
    barrier();
    for (uint half_size = gl_WorkGroupSize.x / 2; half_size > 0; half_size /= 2)
    {
        if (thread < half_size)
            partial[thread] = merge(partial[thread], partial[thread + half_size]);
        barrier();
    }
    return partial[0];
}

#endif
