#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the islands: cloths that may come near each other until the lists are made again, if those of an island move on
// average, and its frame, as fast as they do now. Finds these frames, too. One workgroup for all cloths; a thread takes every so many of them.
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
#include "pairs/frame_shift.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/moving_frame.glsl"
#include "pairs/pair_tree.glsl"
#include "shared/box.glsl"
#include "shared/ordered.glsl"

// What packing rounds off a carry, as a part of it (sweep.glsl), and more.
const float k_packing = 0.01;

shared uint shared_joined; // whether islands have been joined in a round
// Of as many cloths as there are threads: where they may come, and their layers and islands. No layer: no cloth.
shared Box shared_reaches[gl_WorkGroupSize.x];
shared uint shared_layers[gl_WorkGroupSize.x];
shared uint shared_islands[gl_WorkGroupSize.x];

void wait_for_all()
{
    memoryBarrierBuffer();
    barrier();
}

bool exists(uint cloth) { return cloth < push.cloths && pair_islands[cloth].high[0] != 0; }

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

void clear_total(uint cloth)
{
    pair_islands[cloth].joined = 0;
    pair_islands[cloth].total_vertices = pair_islands[cloth].total_clear = pair_islands[cloth].total_stopped = 0;
    pair_islands[cloth].total_mass = 0;
    pair_islands[cloth].heaviest = 0;
    for (uint k = 0; k < 3; ++k)
        pair_islands[cloth].total_momentum[k] = pair_islands[cloth].total_moment[k] = 0;
    pair_islands[cloth].total_frame_sums = no_frame_sums();
}

// m, from the origin of the island to that of a cloth of it.
vec3 origin_in_island(uint cloth) { return frame_of(cloth).origin - frame_of(island_of(cloth)).origin; }

void add_frame_sums(uint cloth)
{
    const uint island = island_of(cloth);
    float sums[VOILE_FRAME_SUMS] = sums_of(pair_islands[cloth].frame_sums);
    shift(sums, origin_in_island(cloth), pair_islands[cloth].vertices);
    atomicAdd(pair_islands[island].total_frame_sums.restrained, pair_islands[cloth].frame_sums.restrained);
    for (uint k = 0; k < VOILE_FRAME_SUMS; ++k)
    {
        const ivec2 words = frame_words(sums[k], k, push.cloths);
        atomicAdd(pair_islands[island].total_frame_sums.low[k], uint(words.x));
        atomicAdd(pair_islands[island].total_frame_sums.high[k], words.y);
    }
}

void add_to_total(uint cloth)
{
    const uint island = island_of(cloth);
    atomicAdd(pair_islands[island].total_vertices, pair_islands[cloth].vertices);
    atomicAdd(pair_islands[island].total_clear, pair_islands[cloth].clear);
    atomicMax(pair_islands[island].total_stopped, pair_islands[cloth].stopped);
    const float part = cloths[cloth].pair_mass / max(uintBitsToFloat(pair_islands[island].heaviest), 1e-30);
    const float mass = float(pair_islands[cloth].mass);
    const vec3 shift = origin_in_island(cloth);
    atomicAdd(pair_islands[island].total_mass, uint(round(part * mass)));
    for (uint k = 0; k < 3; ++k)
    {
        const float moved = mass * (VOILE_PAIR_UNIT_MASS / VOILE_PAIR_UNIT_SPEED) * shift[k];
        atomicAdd(pair_islands[island].total_momentum[k], int(round(part * float(pair_islands[cloth].momentum[k]))));
        atomicAdd(pair_islands[island].total_moment[k], int(round(part * (float(pair_islands[cloth].moment[k]) + moved))));
    }
    add_frame_sums(cloth);
}

// In the first cloth of an island.
void find_frame(uint island)
{
    const FrameSums sums = pair_islands[island].total_frame_sums;
    write_frame(island, frame_from(sums.restrained, sums_of(sums), pair_islands[island].total_vertices));
}

// A vertex is carried with its frame, as long as lists are used, and by a part of the mean way in it. From there it
// goes as far as its sweep and its reach.
void write_reach(uint cloth)
{
    const uint island = island_of(cloth);
    const MovingFrame frame = frame_of(island);
    const uint mass = pair_islands[island].total_mass;
    const vec3 mean = mean_of(pair_islands[island].total_momentum, mass);
    const vec3 mean_from = velocity_at(frame.motion, mean_of(pair_islands[island].total_moment, mass));
    const vec3 carry = step_input.list_time * (mean - mean_from);
    const vec3 moved = step_input.list_time * frame.motion.velocity;
    const Box box = box_of(cloth);
    const float farthest = length(max(abs(box.min - frame.origin), abs(box.max - frame.origin)));
    const float margin = cloths[cloth].pair_sweep + cloths[cloth].pair_range + step_input.pair_fall +
                         k_packing * length(carry) + rounding(box.min) + rounding(box.max) +
                         step_input.list_time * length(frame.motion.angular_velocity) * farthest;
    for (uint k = 0; k < 3; ++k)
    {
        pair_islands[cloth].reach_low[k] = box.min[k] + min(carry[k], 0) + min(moved[k], 0) - margin;
        pair_islands[cloth].reach_high[k] = box.max[k] + max(carry[k], 0) + max(moved[k], 0) + margin;
    }
}

void share(uint thread, uint cloth)
{
    shared_layers[thread] = 0;
    if (!exists(cloth))
        return;
    shared_reaches[thread] = reach_of(cloth);
    shared_layers[thread] = cloths[cloth].layers;
    shared_islands[thread] = island_of(cloth);
}

// Joins the island of a cloth with those of the shared cloths, from `first` on, before it that it may meet. The later
// island gets the earlier one's name.
void join(uint cloth, uint first)
{
    const Box reach = reach_of(cloth);
    const uint layers = cloths[cloth].layers;
    const uint island = island_of(cloth);
    const uint count = min(cloth - first, gl_WorkGroupSize.x);
    for (uint k = 0; k < count; ++k)
    {
        const uint other = shared_islands[k];
        if ((shared_layers[k] & layers) == 0 || !overlap(reach, shared_reaches[k]) || other == island)
            continue;
        const uint later = max(island, other);
        atomicMax(pair_islands[later].joined, later - min(island, other));
        shared_joined = 1;
    }
}

void join_all(uint thread)
{
    for (uint first = 0; first < push.cloths; first += gl_WorkGroupSize.x)
    {
        barrier();
        share(thread, first + thread);
        barrier();
        for (uint c = first + thread; c < push.cloths; c += gl_WorkGroupSize.x)
            if (exists(c))
                join(c, first);
    }
}

void rename(uint cloth)
{
    uint first = island_of(cloth);
    for (uint joined = pair_islands[first].joined; joined != 0; joined = pair_islands[first].joined)
        first -= joined;
    pair_islands[cloth].before = cloth - first;
}

void copy_frame(uint cloth, MovingFrame frame)
{
    write_frame(cloth, frame.motion);
    for (uint k = 0; k < 3; ++k)
        pair_islands[cloth].frame_origin[k] = frame.origin[k];
}

// Sums over islands as they are called now, and their frames.
void find_totals(uint thread)
{
    for (uint c = thread; c < push.cloths; c += gl_WorkGroupSize.x)
        clear_total(c);
    wait_for_all();
    for (uint c = thread; c < push.cloths; c += gl_WorkGroupSize.x)
        if (exists(c))
            atomicMax(pair_islands[island_of(c)].heaviest, floatBitsToUint(cloths[c].pair_mass));
    wait_for_all();
    for (uint c = thread; c < push.cloths; c += gl_WorkGroupSize.x)
        if (exists(c))
            add_to_total(c);
    wait_for_all();
    for (uint c = thread; c < push.cloths; c += gl_WorkGroupSize.x)
        if (pair_islands[c].before == 0)
            find_frame(c);
    wait_for_all();
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
        find_totals(thread);
        if (thread == 0)
            shared_joined = 0;
        for (uint c = thread; c < push.cloths; c += threads)
            if (exists(c))
                write_reach(c);
        wait_for_all();
        join_all(thread);
        wait_for_all();
        joined = shared_joined != 0;
        for (uint c = thread; c < push.cloths; c += threads)
            rename(c);
    }
    // In the last round no name has changed.
    for (uint c = thread; c < push.cloths; c += threads)
        if (pair_islands[c].before > 0)
            copy_frame(c, frame_of(island_of(c)));
    for (uint c = thread; c < push.cloths; c += threads)
        if (exists(c) && pair_islands[c].before == 0)
        {
            pair_islands[c].vertices = pair_islands[c].total_vertices;
            pair_islands[c].clear = pair_islands[c].total_clear;
            pair_islands[c].mass = pair_islands[c].total_mass;
            for (uint k = 0; k < 3; ++k)
            {
                pair_islands[c].momentum[k] = pair_islands[c].total_momentum[k];
                pair_islands[c].moment[k] = pair_islands[c].total_moment[k];
            }
            pair_islands[c].stopped = pair_islands[c].total_stopped;
        }
}
