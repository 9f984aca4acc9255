#version 460
#extension GL_GOOGLE_include_directive : require
// Of the pairs that a vertex lists (find_pairs.comp), those that the owner of the other side lists, too. Only these are
// pairs. Up to the nearest of the others, the list is complete. As in find_pairs.comp, push.lanes neighboring threads
// share a vertex that searches.
//
// Whether both sides list a pair cannot be derived from its distance, because each side leaves out pairs by boxes, by
// flat neighborhoods and by a range of its own. Let d be the distance of a pair that at most one side lists. The range
// of a side that does not list it is at most d. The other side either has no such range or lists the pair, and its range
// shrinks to at most d here.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(pairs)) readonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_distances)) readonly buffer PairDistances { float pair_distances[]; };
layout(VOILE_BINDING(pair_masks)) readonly buffer PairMasks { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(pair_lists)) buffer PairLists { PairList pair_lists[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/pair.glsl"

shared float shared_ranges[gl_WorkGroupSize.x];
shared uint shared_masks[gl_WorkGroupSize.x];

bool lists(uint owner, uvec4 words)
{
    const uint count = pair_lists[owner].count;
    for (uint e = 0; e < count; ++e)
        if (pairs[owner * VOILE_PAIRS + e] == words)
            return true;
    return false;
}

// What a thread knows of the list of its vertex.
struct Matched
{
    float range;
    uint mask;
};

void match(uint owner, uint place, inout Matched matched)
{
    const uint entry = owner * VOILE_PAIRS + place;
    const uvec4 words = pairs[entry];
    const uvec2 owners = owners_of(unpacked(words));
    if (lists(owners.x == owner ? owners.y : owners.x, words))
        matched.mask |= 1u << place;
    else
        matched.range = min(matched.range, pair_distances[entry]);
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint lane = thread % push.lanes;
    const uint place = gl_GlobalInvocationID.x / push.lanes;
    const uint entries = pair_passes[VOILE_PAIR_FIND].entries;
    if (place - thread / push.lanes >= entries) // of the first thread of the workgroup
        return;
    const bool searches = place < entries;
    const uint owner = searches ? searching_vertices[place] : 0;
    Matched matched = Matched(0, 0);
    if (searches)
    {
        matched.range = pair_lists[owner].range;
        const uint count = pair_lists[owner].count;
        for (uint e = lane; e < count; e += push.lanes)
            match(owner, e, matched);
    }
    shared_ranges[thread] = matched.range;
    shared_masks[thread] = matched.mask;
    barrier();
    if (!searches || lane != 0)
        return;
    for (uint k = 1; k < push.lanes; ++k)
    {
        matched.range = min(matched.range, shared_ranges[thread + k]);
        matched.mask |= shared_masks[thread + k];
    }
    pair_lists[owner].range = matched.range;
    pair_lists[owner].mask = matched.mask;
}
