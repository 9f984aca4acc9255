#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// What each listed pair does in a pass. One thread per entry of a list. Both sides list a pair, so two threads compute
// the same bits, each for the vertices of its side.
//
// respond_to_pairs.comp gathers the results. Impulses are those of one Jacobi iteration with mass splitting (Tonge et
// al. 2012, "Mass splitting for jitter-free parallel rigid body simulation"): a vertex divides its mass among the pairs
// that push it, by its weights in them. Here the weights of a vertex are summed up.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pairs)) readonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_thicknesses)) readonly buffer PairThicknesses { float pair_thicknesses[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_entries)) readonly buffer PairEntries { uint pair_entries[]; };
layout(VOILE_BINDING(pair_lists)) readonly buffer PairLists { PairList pair_lists[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_passes)) readonly buffer PairPasses { PairDispatch pair_passes[]; };
layout(VOILE_BINDING(pair_memories)) readonly buffer PairMemories { PairMemory pair_memories[]; };
layout(VOILE_BINDING(pair_loads)) buffer PairLoads { uint pair_loads[]; };
layout(VOILE_BINDING(pair_responses)) writeonly buffer PairResponses { PairResponse pair_responses[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/fine_position.glsl"
#include "contact/friction_law.glsl"
#include "pairs/clock.glsl"
#include "pairs/direction.glsl"
#include "pairs/forced.glsl"
#include "pairs/halvings.glsl"
#include "pairs/pair.glsl"
#include "pairs/push.glsl"

// The part of the thickness below which a pair comes closer slowly, by this part of what it has above the least.
const float k_floor = 0.1;
const float k_near_floor = 0.25;
// The least part of the thickness. Pairs that begin closer may not approach.
const float k_least = 0.02;
// The part of its room within which the clock may lead a pair together. What it leads together it presses together, whatever
// springs pull at it: with twice the room, cloth gathered by pins shook itself to 50 m/s.
const float k_carried_part = 0.5;
// A pair that is closer than its thickness parts by this part of what is missing, per pass, but not faster than lift_of says,
// and that is at most, m/s:
const float k_part = 0.2;
const float k_lift_speed = 0.25;
// Pairs that miss each other by less than this part of the thickness bounce: they drift until they touch again.
const float k_near = 0.1;
// The part of the drift of pairs that stick that is undone in a pass.
const float k_undo_slip = 0.15;
const float k_unbounded = 1e30;
// m: where both sides are at one point, no plane separates them. A plane through it would let them part, but not
// come back, whatever pulls at them.
const float k_sideless_room = 1e3;
const float k_least_lever = 0.01;
// m, as a part of coordinates beyond 1 m: what is so near each other is at one place, too, and has no sides.
const float k_touch = 1e-7;
// A collider supports a vertex that is pushed towards it by at least this part.
const float k_least_support = 0.7;
// The most by which that strengthens an impulse: then sides of equal mass would bounce if there was no support.
const float k_most_support = 2;
const float k_most_half = 65504;
// Halfs are rounded by less than this part, and small ones by less than this, m.
const float k_half_rounding = 1e-3;
const float k_least_half = 6e-8;
// rad: by how much packing tilts a direction at most (measured for a million: 6.4e-5).
const float k_direction_rounding = 6.5e-5;

// The vertices of a pair at the start of the pass.
struct Vertices
{
    vec3 x[4]; // m, from the first
    vec3 v[4]; // m/s, in the frame of the island
    vec3 gain[4]; // m/s, until the middle of the coming interval, if what acted since the last pass goes on
    vec3 moved[4]; // m, since the last pass, but for how the frame turns
    vec3 slip[4];
    vec3 carry[4]; // m, until the next pass if the clock runs as fast as time, relative to the first
    vec4 inverse_masses;
    bvec4 supported; // by a collider
    uint island;
};

// What the vertices of a pair are relative to.
struct Frame
{
    FinePosition origin; // the first vertex, and how it is carried
    uint carry;
    vec3 fall; // of the island (free_fall_until_next)
    vec3 velocity; // m/s
    vec3 angular_velocity; // rad/s
    vec3 turn; // since lists were made
};

// `first`: vertex of the pair.
Frame frame_at(uint first, uint cloth)
{
    const MovingFrame frame = frame_of(cloth);
    const float time = time_at_pass(cloth);
    const FinePosition origin = FinePosition(positions[first].xyz, unpack_residual(residuals[first]));
    return Frame(origin, pair_carries[first], free_fall_until_next(cloth), velocity_at(frame, origin.x, time),
                 frame.motion.angular_velocity, turn_in(frame, time));
}

void read_vertex(uint i, uint k, Frame frame, inout Vertices vertices)
{
    const vec4 position = positions[i];
    const PairMemory memory = pair_memories[i];
    const bool known = is_of_last_pass(memory.pass);
    const vec4 velocity = velocities[i];
    vertices.supported[k] = (uint(velocity.w) & VOILE_VERTEX_SUPPORTED) != 0;
    vertices.x[k] = displacement(frame.origin, FinePosition(position.xyz, unpack_residual(residuals[i])));
    const vec3 turning = cross(frame.angular_velocity, vertices.x[k]);
    vertices.v[k] = velocity.xyz - frame.velocity - turning;
    vertices.gain[k] = known && position.w > 0 ? 0.5 * (velocity.xyz - memory.velocity) : vec3(0);
    const PairGuard guard = pair_bounds[i].guard;
    const FinePosition last = FinePosition(guard.from, unpack_residual(guard.residual));
    const vec3 moved = displacement(last, FinePosition(position.xyz, unpack_residual(residuals[i])));
    vertices.moved[k] = known ? moved - pair_interval() * turning : vec3(0);
    vertices.slip[k] = known ? memory.slip : vec3(0);
    vertices.carry[k] = turned(frame.turn, carry_until_next(pair_carries[i], frame.carry, frame.fall));
    vertices.inverse_masses[k] = position.w;
}

vec3 weighted(vec4 weights, vec3 a[4])
{
    return weights.x * a[0] + weights.y * a[1] + weights.z * a[2] + weights.w * a[3];
}

// Of both cloths: the geometric mean.
vec2 friction_of(Pair pair)
{
    return sqrt(unpackHalf2x16(pair_memories[pair.vertices.x].friction) *
                unpackHalf2x16(pair_memories[pair.vertices.w].friction));
}

// How much stronger the impulse of a pair is because colliders support one side. What a collider holds or drives does not
// give way: without this it would take several passes until the other side is as fast, and meanwhile both come nearer.
float support_of(Pair pair, vec4 weights, Vertices vertices, vec3 n)
{
    if (!any(vertices.supported))
        return 1;
    const vec4 mobilities = weights * weights * vertices.inverse_masses;
    vec4 gives_way = vec4(1);
    [[unroll]] for (uint k = 0; k < 4; ++k)
        if (vertices.supported[k])
        {
            const vec3 support = unpack_direction(pair_bounds[pair.vertices[k]].guard.support);
            gives_way[k] = dot(k < first_side(pair) ? n : -n, support) < -k_least_support ? 0 : 1;
        }
    const float mobility = dot(mobilities, vec4(1));
    return min(mobility / max(dot(mobilities, gives_way), 1e-30), k_most_support);
}

// 0..1: the part of an impulse with which no vertex changes its velocity by more than the pair does. Less than 1 only where
// the nearest point is almost at a vertex without mass, or one that is much heavier than its neighbors: to move it, they
// would have to move farther by the inverse of their weights, and where pins press cloth into itself that is in vain.
float lever_of(vec4 weights, vec4 mobilities)
{
    const vec4 own = abs(mobilities);
    return min(dot(weights, mobilities) / max(max(max(own.x, own.y), max(own.z, own.w)), 1e-30), 1);
}

// m/s, predicted for the middle of the coming interval, of the first side relative to the other. What presses the sides
// together goes on. Along them it does not: springs pull back what friction has moved, and to expect more of that makes
// layers shake.
vec3 relative_velocity(vec4 weights, Vertices vertices, vec3 n)
{
    return weighted(weights, vertices.v) + dot(weighted(weights, vertices.gain), n) * n;
}

// Whether both sides are at one point, where pins or the host have put them. `near`: m, a vertex of the pair.
bool is_at_one_place(float apart, float lever, float thickness, vec3 near)
{
    const float largest = max(max(abs(near.x), abs(near.y)), abs(near.z));
    return apart < k_touch * max(largest, 1) || (lever < k_least_lever && apart < k_least * thickness);
}

// How both sides of a pair move relative to each other, at their nearest points.
struct Approach
{
    vec3 velocity; // m/s, of the first side
    vec3 moved;    // m, since the last pass, of the first side
    vec3 slip;     // m, along the sides, that has not been undone
    vec3 n;        // unit, towards the first side
    float missing; // m, of the thickness; below 0: so far apart
    float thickness; // m
    float support;   // by how much the impulse along n is stronger than what the pair needs
    float lift;      // m/s, at which the pair parts at most
};

// m/s: how fast a pair parts. It keeps what it gains, so layers that have sunk a little must not be thrown up. What moves
// without mass needs room at once, and so does what a collider pushes into crowded cloth.
float lift_of(float missing, float thickness, bool driven)
{
    return k_lift_speed * (driven || is_crowded() ? 1 : missing / thickness);
}

// The velocity that the pair removes or adds, and how far it has slid since the last pass if it sticks, in `drift`.
vec3 impulse_of(Approach approach, vec2 friction, out vec3 drift)
{
    drift = vec3(0);
    const float missing = approach.missing / pair_interval();
    const float along = dot(approach.velocity, approach.n);
    const float wanted = (missing < 0 ? missing : min(k_part * missing, approach.lift)) - along;
    const vec3 sliding = approach.velocity - along * approach.n;
    // Packed as halfs: beyond their range it would be infinite, and the slip it adds up to not a number.
    const vec3 slid = clamp(approach.moved - dot(approach.moved, approach.n) * approach.n, vec3(-k_most_half), vec3(k_most_half));
    if (wanted <= 0)
    {
        if (approach.missing > -k_near * approach.thickness)
            drift = slid;
        return vec3(0);
    }
    const vec3 slip = approach.slip - dot(approach.slip, approach.n) * approach.n;
    const vec3 undo = k_undo_slip / pair_interval() * slip;
    const float speed = length(sliding);
    const float pressure = approach.support * wanted;
    const float spare = friction.x * pressure - speed;
    if (spare >= 0) // it sticks; taking back what has drifted must not make it slide
    {
        drift = slid;
        return pressure * approach.n - sliding - min(1, spare / max(length(undo), 1e-30)) * undo;
    }
    const float left = slip_speed(speed, pressure, friction.x, friction.y);
    return pressure * approach.n - (1 - left / speed) * sliding;
}

// Whether a vertex without mass moves.
bool is_driven(Vertices vertices)
{
    vec3 fastest = vec3(0);
    [[unroll]] for (uint k = 0; k < 4; ++k)
        fastest = vertices.inverse_masses[k] == 0 ? max(fastest, abs(vertices.v[k])) : fastest;
    return any(greaterThan(fastest, vec3(0)));
}

// m: how far vertices without mass, which nothing holds, will move towards the other side until the next pass. The first
// side's, and the second's.
vec2 driven_approach(uint sides, Vertices vertices, Separation separation)
{
    vec2 needed = vec2(0);
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        const bool first = k < sides;
        const float along = pair_interval() * dot(vertices.v[k], first ? -separation.n : separation.n);
        const float approach = vertices.inverse_masses[k] == 0 ? along - separation.from_plane[k] : 0;
        needed = max(needed, first ? vec2(approach, 0) : vec2(0, approach));
    }
    return needed;
}

// m: how far along the normal the planes of both sides are carried, as a half, relative to the first vertex. Vertices
// without mass are not carried, so their plane is not, either. `of_first`: m, that vertex' carry. Equal carries give 0,
// so that pairs need no room for rounding.
float carry_of_planes(uint sides, Vertices vertices, Separation separation, vec3 of_first)
{
    float low = k_unbounded;
    float high = -k_unbounded;
    [[unroll]] for (uint k = 0; k < 4; ++k)
    {
        const float along = dot(separation.n, vertices.carry[k]);
        if (k < sides)
            low = min(low, along + separation.from_plane[k]);
        else
            high = max(high, along - separation.from_plane[k]);
    }
    const bool driven = any(equal(vertices.inverse_masses, vec4(0)));
    const float carry = driven ? -dot(separation.n, of_first) : 0.5 * (low + high);
    return unpackHalf2x16(packHalf2x16(vec2(carry, 0))).x;
}

// m: the part of the gap that a pair may use up, in several passes. Without any, a pair that begins nearer than the floor
// could not part either: guards of slightly different normals without room leave a point.
float spare_gap(float gap, float thickness)
{
    return max(0, max(gap - k_floor * thickness, k_near_floor * (gap - k_least * thickness)));
}

void add_load(uint vertex, float weight)
{
    atomicAdd(pair_loads[(pair_pass() & 1u) * push.vertices + vertex], uint(ceil(abs(weight) * VOILE_PAIR_UNIT_LOAD)));
}

// m: how far packing the direction tilts a side out of its plane. Vertices that are behind it by no more may not approach: the next
// pass rounds another direction, so that sides which are pressed together would come nearer in each. `own`: as in heights_of.
float tilt_of(uvec2 own, Vertices vertices)
{
    float squared_length = 0;
    for (uint k = own.x; k < own.y; ++k)
    {
        const vec3 d = vertices.x[k] - vertices.x[own.x];
        squared_length = max(squared_length, dot(d, d));
    }
    return 2 * k_direction_rounding * sqrt(squared_length) + k_least_half;
}

// How far the vertices of the own side may approach, `slack` for all, and how far the clock carries the planes
// (PairResponse::heights). Where it would lead them together by more than a part of `slack`, it slows down.
// `own`: the first place of the side, and the first one after it.
uvec2 heights_of(uvec2 own, Vertices vertices, Separation separation, float slack, float carry)
{
    const float room = k_carried_part * slack;
    const float tilt = tilt_of(own, vertices);
    vec3 heights = vec3(0);
    float rate = 1;
    for (uint k = own.x; k < own.y; ++k)
    {
        const float nearer = (carry - dot(separation.n, vertices.carry[k])) * (own.x == 0 ? 1 : -1);
        if (nearer > separation.from_plane[k] + room)
            rate = min(rate, (separation.from_plane[k] + room) / nearer);
        heights[k - own.x] = (1 - k_half_rounding) * (max(separation.from_plane[k] - tilt, 0) + slack);
    }
    if (rate < 1)
        atomicMin(pair_islands[vertices.island].rates[pair_pass() & 1u], floatBitsToUint(rate));
    return uvec2(packHalf2x16(heights.xy), packHalf2x16(vec2(heights.z, carry)));
}

void meet(uint entry)
{
    const Pair pair = unpacked(pairs[entry]);
    const uvec2 owners = owners_of(pair);
    const bool first = owners.x == entry / VOILE_PAIRS;
    const float thickness = pair_thicknesses[entry];
    PairResponse response;
    const uint cloth = pair_lists[entry / VOILE_PAIRS].cloth;
    const Frame frame = frame_at(pair.vertices.x, cloth);
    Vertices vertices;
    vertices.island = island_of(cloth);
    [[unroll]] for (uint k = 0; k < 4; ++k)
        read_vertex(pair.vertices[k], k, frame, vertices);
    const Nearest nearest = nearest_points(pair.edges, vertices.x);
    const float apart = length(nearest.apart);
    const vec3 direction = separating_direction(pair.edges, vertices.x, nearest);
    response.normal = pack_direction(direction / max(length(direction), 1e-20));
    const vec3 n = unpack_direction(response.normal);
    const vec3 along = push_direction(pair.edges, vertices.x, n);
    const Approach approach =
        Approach(relative_velocity(nearest.weights, vertices, along), weighted(nearest.weights, vertices.moved),
                 weighted(nearest.weights, vertices.slip), along, thickness - apart, thickness,
                 support_of(pair, nearest.weights, vertices, along), lift_of(thickness - apart, thickness, is_driven(vertices)));
    response.mobilities = nearest.weights * vertices.inverse_masses;
    const float lever = lever_of(nearest.weights, response.mobilities);
    vec3 drift = vec3(0);
    response.impulse = vec3(0);
    const float uncovered = uncovered_part(pair.edges, vertices.x, nearest.weights);
    if (uncovered > 0)
        response.impulse = uncovered * lever * impulse_of(approach, friction_of(pair), drift);
    const bool massless = any(equal(vertices.inverse_masses, vec4(0)));
    response.drift = uvec2(packHalf2x16(drift.xy), packHalf2x16(vec2(drift.z, massless ? 1 : 0)));

    const Separation separation = separate(pair.edges, vertices.x, n);
    const uint sides = first_side(pair);
    const vec2 needed = driven_approach(sides, vertices, separation);
    const float room = 2 * VOILE_PAIR_APPROACH * spare_gap(separation.gap, thickness);
    const float spare = room - needed.x - needed.y;
    const bool sideless = is_at_one_place(apart, lever, thickness, positions[pair.vertices.x].xyz);
    if ((spare < 0 || sideless) && first)
        count_forced();
    const float slack = sideless ? k_sideless_room : max((first ? needed.x : needed.y) + 0.5 * spare, 0);
    const uvec2 own = first ? uvec2(0, sides) : uvec2(sides, 4);
    const float carry = carry_of_planes(sides, vertices, separation,
                                        turned(frame.turn, carry_until_next(frame.carry, frame.fall)));
    response.heights = heights_of(own, vertices, separation, slack, carry);
    pair_responses[entry] = response;
    for (uint k = own.x; k < own.y && response.impulse != vec3(0); ++k)
        add_load(pair.vertices[k], nearest.weights[k]);
}

void main()
{
    const uint threads = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    for (uint k = gl_GlobalInvocationID.x; k < pair_passes[VOILE_PAIR_MEET].entries; k += threads)
        meet(pair_entries[k]);
}
