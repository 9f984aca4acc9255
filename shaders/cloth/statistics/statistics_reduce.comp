#version 460
#extension GL_GOOGLE_include_directive : require
// Merges the statistics of all patches. One workgroup: each thread merges every group-size-th patch, then the workgroup
// folds. Intersections are copied afterwards, if they were counted.
#include "shared/bindings.h"
#include "shared/pair_layout.h"
#include "shared/statistics_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(partials)) readonly buffer Partials { StatisticsRecord partials[]; };
layout(VOILE_BINDING(statistics)) writeonly buffer Statistics { StatisticsResult result[]; };

layout(VOILE_BINDING(pair_bounds)) readonly buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { StatisticsReducePush push; };

#include "statistics/statistics_merge.glsl"

void main()
{
    StatisticsRecord record = no_statistics();
    for (uint c = gl_LocalInvocationID.x; c < push.patches; c += gl_WorkGroupSize.x)
        record = merge(record, partials[c]);
    const StatisticsRecord merged = merge_workgroup(record);
    if (gl_LocalInvocationID.x != 0)
        return;
    result[push.slot].cloths = merged;
    if (push.pairs_met != 0)
    {
        result[push.slot].cloths.forced_pairs = pair_searches[VOILE_PAIR_FORCED].entries;
        result[push.slot].cloths.tangled_pairs = pair_searches[VOILE_PAIR_TANGLED].entries;
        result[push.slot].cloths.pair_searches = pair_searches[VOILE_PAIR_SEARCHED].entries;
    }
    result[push.slot].intersections = IntersectionCounters(0, 0, 0, 0);
}
