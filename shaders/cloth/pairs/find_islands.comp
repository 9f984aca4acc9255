#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the islands: cloths that may come near each other until the lists are made again, if those of an island move on
// average as fast as they do now. One workgroup for all cloths; a thread takes every so many of them.
//
// In each round, islands are joined by the names that they have at its beginning, so that the result does not depend on
// timing.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(pair_islands)) coherent buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "contact/rounding.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/pair_tree.glsl"
#include "shared/box.glsl"
#include "shared/ordered.glsl"

// What packing rounds off a carry, as a part of it (sweep.glsl), and more.
const float k_packing = 0.01;

shared uint shared_joined; // whether islands have been joined in a round

void wait_for_all()
{
    memoryBarrierBuffer();
    barrier();
}

bool exists(uint cloth) { return pair_islands[cloth].high[0] != 0; }

Box box_of(uint cloth)
{
    Box box;
    for (uint k = 0; k < 3; ++k)
    {
        box.min[k] = from_ordered(~pair_islands[cloth].low[k]);
        box.max[k] = from_ordered(pair_islands[cloth].high[k]);
    }
    return box;
}

Box reach_of(uint cloth)
{
    Box box;
    for (uint k = 0; k < 3; ++k)
    {
        box.min[k] = pair_islands[cloth].reach_low[k];
        box.max[k] = pair_islands[cloth].reach_high[k];
    }
    return box;
}

// What the cloths of an island add up to.
struct Total
{
    uint vertices;
    uint clear;
    ivec3 velocity;
    uint stopped;
};

Total total_of(uint island)
{
    Total total = Total(0, 0, ivec3(0), 0);
    for (uint c = island; c < push.cloths; ++c)
        if (exists(c) && island_of(c) == island)
        {
            total.vertices += pair_islands[c].vertices;
            total.clear += pair_islands[c].clear;
            total.velocity += velocities_of(c);
            total.stopped = max(total.stopped, pair_islands[c].stopped);
        }
    return total;
}

// A vertex is carried by a part of the mean way, and from there it goes as far as its sweep and its reach.
void write_reach(uint cloth)
{
    const Total total = total_of(island_of(cloth));
    const vec3 carry = VOILE_PAIR_SWEEP_TIME * mean_of(total.velocity, total.clear);
    const Box box = box_of(cloth);
    const float margin = cloths[cloth].pair_sweep + cloths[cloth].pair_range + step_input.pair_fall +
                         k_packing * length(carry) + rounding(box.min) + rounding(box.max);
    for (uint k = 0; k < 3; ++k)
    {
        pair_islands[cloth].reach_low[k] = box.min[k] + min(carry[k], 0) - margin;
        pair_islands[cloth].reach_high[k] = box.max[k] + max(carry[k], 0) + margin;
    }
}

// Joins the island of a cloth with those of all before it that may come near. The later island gets the earlier one's name.
void join(uint cloth)
{
    const Box reach = reach_of(cloth);
    const uint island = island_of(cloth);
    for (uint other = 0; other < cloth; ++other)
    {
        if (!exists(other) || !meets(cloth, other) || !overlap(reach, reach_of(other)))
            continue;
        const uint with = island_of(other);
        if (with == island)
            continue;
        const uint later = max(island, with);
        atomicMax(pair_islands[later].joined, later - min(island, with));
        shared_joined = 1;
    }
}

void rename(uint cloth)
{
    uint first = island_of(cloth);
    for (uint joined = pair_islands[first].joined; joined != 0; joined = pair_islands[first].joined)
        first -= joined;
    pair_islands[cloth].before = cloth - first;
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint threads = gl_WorkGroupSize.x;
    for (uint c = thread; c < push.cloths; c += threads)
        pair_islands[c].stopped = pair_islands[island_of(c)].stopped;
    wait_for_all();
    for (uint c = thread; c < push.cloths; c += threads)
        pair_islands[c].before = 0;
    bool joined = true;
    while (joined)
    {
        wait_for_all();
        if (thread == 0)
            shared_joined = 0;
        for (uint c = thread; c < push.cloths; c += threads)
        {
            pair_islands[c].joined = 0;
            if (exists(c))
                write_reach(c);
        }
        wait_for_all();
        for (uint c = thread; c < push.cloths; c += threads)
            if (exists(c))
                join(c);
        wait_for_all();
        joined = shared_joined != 0;
        for (uint c = thread; c < push.cloths; c += threads)
            rename(c);
    }
    wait_for_all();
    for (uint c = thread; c < push.cloths; c += threads)
        if (exists(c) && pair_islands[c].before == 0)
        {
            const Total total = total_of(c);
            pair_islands[c].vertices = total.vertices;
            pair_islands[c].clear = total.clear;
            for (uint k = 0; k < 3; ++k)
                pair_islands[c].velocity[k] = total.velocity[k];
            pair_islands[c].stopped = total.stopped;
        }
}
