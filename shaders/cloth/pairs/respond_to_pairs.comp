#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers what the pairs around a vertex do in a pass (meet_pairs.comp): its change of velocity, and the guard within
// which no listed pair can meet until the next pass. push.threads neighboring threads share the pairs of a vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(stage_velocities)) buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pairs)) readonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_references)) readonly buffer PairReferences { uint pair_references[]; };
layout(VOILE_BINDING(pair_responses)) readonly buffer PairResponses { PairResponse pair_responses[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(paired_vertices)) readonly buffer PairedVertices { uvec4 paired_vertices[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(next_pair_pass)) writeonly buffer NextPairPass { PairDispatch next_pair_pass[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_loads)) buffer PairLoads { uint pair_loads[]; };
layout(VOILE_BINDING(pair_memories)) buffer PairMemories { PairMemory pair_memories[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/fine_position.glsl"
#include "pairs/clock.glsl"
#include "pairs/direction.glsl"
#include "pairs/pair.glsl"
#include "pairs/guard.glsl"
#include "pairs/halvings.glsl"
#include "pairs/moving_frame.glsl"
#include "pairs/patience.glsl"

// m: the longest drift that is undone, as a part of the thickness.
const float k_longest_slip = 0.02;
const float k_keep_slip = 0.999;

struct Gather
{
    vec3 change;    // m/s
    float touching; // the sum of the weights in pairs that push or drift
    vec3 drift;     // m, weighted
    float massless; // pairs with a vertex without mass
    PairGuard guard;
};

// The vertex that gathers.
struct Self
{
    uint vertex;
    uint first; // of its references
    uint count;
    float inverse_mass;
    uint carry;
    float rate; // of the clock
    vec3 fall;  // of the island (free_fall_until_next)
    vec3 turn;  // of the frame, since lists were made
};

shared vec4 shared_parts[3 * gl_WorkGroupSize.x];

// Of planes (guard.glsl), the same for all vertices.
float looseness() { return is_crowded() ? 1 / k_tight : 1; }

Gather nothing()
{
    return Gather(vec3(0), 0, vec3(0), 0, no_guard());
}

void store_sums(uint thread, Gather sum)
{
    shared_parts[3 * thread] = vec4(sum.change, sum.touching);
    shared_parts[3 * thread + 1] = vec4(sum.drift, sum.massless);
}

void add_sums(uint thread, inout Gather sum)
{
    const vec4 change = shared_parts[3 * thread];
    sum.change += change.xyz;
    sum.touching += change.w;
    sum.drift += shared_parts[3 * thread + 1].xyz;
    sum.massless += shared_parts[3 * thread + 1].w;
}

void store_guard(uint thread, PairGuard guard)
{
    shared_parts[3 * thread] = guard.planes[0];
    shared_parts[3 * thread + 1] = guard.planes[1];
    shared_parts[3 * thread + 2] = vec4(guard.reach);
}

void join_guard(uint thread, inout PairGuard guard)
{
    guard.reach = min(guard.reach, shared_parts[3 * thread + 2].x);
    add_plane(guard, shared_parts[3 * thread], looseness());
    add_plane(guard, shared_parts[3 * thread + 1], looseness());
}

// What all threads of a vertex have gathered, in the first of them. The order is that of the lists, so that the result
// does not depend on timing. Sums and guards take the same memory in turn.
void merge(uint thread, uint lane, inout Gather sum)
{
    for (uint width = push.threads / 2; width > 0; width /= 2)
    {
        barrier();
        store_sums(thread, sum);
        barrier();
        if (lane < width)
            add_sums(thread + width, sum);
    }
    for (uint width = push.threads / 2; width > 0; width /= 2)
    {
        barrier();
        store_guard(thread, sum.guard);
        barrier();
        if (lane < width)
            join_guard(thread + width, sum.guard);
    }
}

// 1/kg: the inverse mass of the pair, each vertex with the part of its mass that the pair gets.
float split_mobility(Pair pair, PairResponse response)
{
    const uint first = (pair_pass() & 1u) * push.vertices;
    const vec4 loads = vec4(pair_loads[first + pair.vertices.x], pair_loads[first + pair.vertices.y],
                            pair_loads[first + pair.vertices.z], pair_loads[first + pair.vertices.w]);
    return dot(abs(response.mobilities), loads) / VOILE_PAIR_UNIT_LOAD;
}

// The planes of a pair are carried, and so is the vertex. Its guard begins where it is nearest to its plane meanwhile.
// `own`: m, as far as the clock carries the vertex; it and `carry` are relative to the first vertex of the pair.
vec4 carried_plane(float rate, vec3 own, vec3 n, float height, float carry)
{
    return vec4(n, max(height - rate * max(carry - dot(n, own), 0), 0));
}

void add_entry(uint entry, Self self, inout Gather sum)
{
    const Pair pair = unpacked(pairs[entry]);
    const uint place = place_in(pair, self.vertex);
    const uint sides = first_side(pair);
    const bool first = place < sides;
    const PairResponse response = pair_responses[entry];
    const vec3 n = unpack_direction(response.normal);
    const vec4 heights = vec4(unpackHalf2x16(response.heights.x), unpackHalf2x16(response.heights.y));
    const float height = entry_of(heights, first ? place : place - sides);
    const vec3 carry = turned(self.turn, carry_until_next(self.carry, pair_carries[pair.vertices.x], self.fall));
    vec4 plane = carried_plane(self.rate, carry, first ? n : -n, height, first ? heights.w : -heights.w);
    plane.w /= looseness();
    add_plane(sum.guard, plane, looseness());
    const bool pushed = response.impulse != vec3(0);
    const vec4 drift = vec4(unpackHalf2x16(response.drift.x), unpackHalf2x16(response.drift.y));
    sum.massless += drift.w;
    if (self.inverse_mass <= 0 || (!pushed && drift.xyz == vec3(0)))
        return;
    const float own = entry_of(response.mobilities, place);
    const float weight = own / self.inverse_mass;
    sum.touching += abs(weight);
    sum.drift += weight * drift.xyz;
    const float mobility = split_mobility(pair, response);
    if (pushed && mobility > 0)
        sum.change += own / mobility * response.impulse;
}

// `entry`: the vertex, its cloth, the first of its references, and their number.
Self self_of(uvec4 entry)
{
    return Self(entry.x, entry.z, entry.w, positions[entry.x].w, pair_carries[entry.x], clock_rate(entry.y),
                free_fall_until_next(entry.y), turn_in(frame_of(entry.y), time_at_pass(entry.y)));
}

Gather gather(Self self, uint lane)
{
    Gather sum = nothing();
    for (uint k = lane; k < self.count; k += push.threads)
        add_entry(pair_references[self.first + k], self, sum);
    return sum;
}

// `v`: m/s, after the pass.
PairMemory remembered(uint i, uint cloth, vec3 v, Gather sum)
{
    const PairMemory before = pair_memories[i];
    PairMemory memory;
    memory.velocity = v;
    memory.pass = memory_word(halvings_of(before.pass));
    const vec3 kept = is_of_last_pass(before.pass) ? k_keep_slip * before.slip : vec3(0);
    const vec3 slip = kept + sum.drift / max(sum.touching, 1e-30);
    const float longest = k_longest_slip * cloths[cloth].pair_thickness;
    memory.slip = sum.touching > 0 ? slip * min(1, longest / max(length(slip), 1e-30)) : vec3(0);
    memory.friction = before.friction;
    return memory;
}

// For the substeps until the next pass, and for that pass.
void keep_clock(uint cloth)
{
    const float clock = clock_at_pass(cloth);
    const float rate = clock_rate(cloth);
    const float fall = fall_at_pass(cloth);
    const float gained = rate * fall_until_next(cloth);
    const uint other = 1 - (pair_pass() & 1u);
    pair_islands[cloth].rate = rate;
    pair_islands[cloth].clock = clock;
    pair_islands[cloth].time = pair_islands[cloth].times[1 - other];
    pair_islands[cloth].fall = fall;
    pair_islands[cloth].fall_rate = gained / pair_interval();
    pair_islands[cloth].clocks[other] = clock + rate * pair_interval();
    pair_islands[cloth].falls[other] = fall + gained;
    pair_islands[cloth].times[other] = pair_islands[cloth].times[1 - other] + pair_interval();
    pair_islands[cloth].rates[other] = floatBitsToUint(1);
    if (is_moving(frame_of(cloth)) && pair_islands[cloth].times[other] + pair_interval() > step_input.list_time)
        want_lists();
}

// For the next search.
void forget_part(uint cloth)
{
    pair_islands[cloth].vertices = pair_islands[cloth].clear = pair_islands[cloth].mass = 0;
    for (uint k = 0; k < 3; ++k)
    {
        pair_islands[cloth].momentum[k] = pair_islands[cloth].moment[k] = 0;
        pair_islands[cloth].low[k] = pair_islands[cloth].high[k] = 0;
    }
    pair_islands[cloth].frame_sums = no_frame_sums();
}

void size_next_pass()
{
    for (uint k = VOILE_PAIR_MEET; k <= VOILE_PAIR_RESPOND; ++k)
        next_pair_pass[k] = PairDispatch(max(pair_passes[k].groups, push.least_groups), 1, 1, 0);
}

// `entry`: of self_of.
void respond(uvec4 entry, Self self, Gather sum)
{
    const uint i = entry.x;
    pair_loads[(1 - (pair_pass() & 1u)) * push.vertices + i] = 0;
    // Integration begins with the impulses, so that springs respond to what they leave.
    const vec4 before = velocities[i];
    const bool asleep = (cloths[entry.y].flags & VOILE_CLOTH_ASLEEP) != 0; // it does not move in this step
    const vec3 v = asleep ? vec3(0) : before.xyz + sum.change;
    velocities[i] = vec4(v, before.w);
    pair_bounds[i].impulse = sum.change;
    pair_memories[i] = remembered(i, entry.y, v, sum);
    pair_bounds[i].guard.planes = sum.guard.planes;
    pair_bounds[i].guard.reach = sum.guard.reach;
    pair_bounds[i].guard.from = positions[i].xyz;
    pair_bounds[i].guard.residual = residuals[i];
    pair_bounds[i].guard.massless = sum.massless > 0 ? 1 : 0;
    const bool verlet = (cloths[entry.y].flags & VOILE_CLOTH_VERLET) != 0;
    const vec3 carry = turned(self.turn, carry_at_pass(self.carry, entry.y, verlet ? seconds(push.lag) : 0));
    const vec3 frame = velocity_at(frame_of(entry.y), positions[i].xyz, time_at_pass(entry.y));
    pair_bounds[i].speed = length(v - frame - self.rate * carry);
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    if (gl_GlobalInvocationID.x == 0)
    {
        age_lists();
        size_next_pass();
    }
    for (uint c = thread; gl_WorkGroupID.x == 0 && c < push.cloths; c += gl_WorkGroupSize.x)
    {
        keep_clock(c);
        forget_part(c);
    }
    const uint lane = thread % push.threads;
    const uint each = gl_WorkGroupSize.x / push.threads; // vertices of a workgroup at a time
    const uint entries = pair_passes[VOILE_PAIR_RESPOND].entries;
    for (uint first = gl_WorkGroupID.x * each; first < entries; first += gl_NumWorkGroups.x * each)
    {
        const uint place = first + thread / push.threads;
        const bool exists = place < entries;
        const uvec4 entry = exists ? paired_vertices[place] : uvec4(0);
        Self self;
        Gather sum = nothing();
        if (exists)
        {
            self = self_of(entry);
            sum = gather(self, lane);
        }
        merge(thread, lane, sum);
        if (exists && lane == 0)
            respond(entry, self, sum);
    }
}
