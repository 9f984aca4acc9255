// Holds vertices within the guards of their pairs (pair_layout.h).
//
// The including kernel declares pair_bounds[], pair_islands[] and push (ContactPush).
#ifndef VOILE_HOLD_GLSL
#define VOILE_HOLD_GLSL

#include "contact/contact_vertex.glsl"
#include "pairs/fall.glsl"
#include "pairs/guard.glsl"
#include "pairs/island.glsl"
#include "pairs/sweep.glsl"
#include "shared/segments.glsl"
#include "shared/step_input.glsl"

// Rounding that guards leave room for, as a part of lengths.
const float k_guard_rounding = 1e-5;

// New lists are made before a vertex has used this part of its reach.
const float k_used_reach = 0.8;

// s, from the last pass over pairs to the start of the motion, and to its end.
float pair_from() { return seconds(push.pair_from); }
float pair_to()
{
    precise const float end = pair_from() + seconds(push.pair_lasts);
    return end;
}

// A vertex within its guards, and where they end, at the end of the motion. The clock of the lists and the frame of the island
// may carry both, and the frame may turn them.
struct Hold
{
    PairBound bound;
    vec3 at;         // m, the start of the motion from the guard's
    vec3 swept;      // m, the start of the motion from the sweep's
    vec3 carry;      // m/s, when the integrator has its velocity
    vec3 carried;    // m, in the time of the motion
    vec3 left;       // m, for which the clock ends too early, until the pass after the next
};

// The clock, m/s, where lists were made: during the motion on average, and when the integrator has its velocity.
struct ClockMotion
{
    vec3 mean;
    vec3 last;
    vec3 carried; // m, until the motion starts
};

// Rotates all that does not turn yet, from how it was at the last pass, or when lists were made, to the end of the motion.
// `from`: of the motion. `integrated`: s, from the last pass, when the integrator has its velocity.
void turn_with(MovingFrame frame, ClockMotion clock, FinePosition from, float integrated, float made, inout Hold hold)
{
    const vec3 before = turn_in(frame, made);
    const vec3 turn = turn_in(frame, pair_to());
    const vec3 r = from_origin(frame, from, made + pair_from());
    const vec3 back = added_by(-turn_in(frame, pair_from()), r); // to where it was at the last pass
    const vec3 added = added_by(before, clock.mean);
    const float time = pair_to() - pair_from();
    const PairSweep sweep = hold.bound.sweep;
    const vec3 sweep_from = from_origin(frame, FinePosition(sweep.from, unpack_residual(sweep.residual)), 0);
    hold.at = turned(turn, hold.at + back - pair_from() * added);
    hold.swept = turned(turn, hold.swept + back - added_by(before, sweep_from + clock.carried));
    hold.carried += back + added_by(turn, r + back) + time * (added + added_by(turn, clock.mean + added));
    hold.carry += added_by(turn, turned(before, clock.last)) + added_by(before, clock.last) +
                  cross(frame.motion.angular_velocity, turned(turn_in(frame, integrated), r + back));
    hold.left = turned(turn, turned(before, hold.left));
    hold.bound.sweep.sweep = turned(turn, turned(before, sweep.sweep));
    for (uint k = 0; k < 2; ++k)
        hold.bound.guard.planes[k].xyz = turned(turn, hold.bound.guard.planes[k].xyz);
}

Hold hold_of(uint i, uint cloth, FinePosition from)
{
    Hold hold;
    const PairSweep sweep = pair_bounds[i].sweep;
    hold.bound.sweep = sweep;
    hold.bound.guard = no_guard();
    hold.bound.impulse = vec3(0);
    if (sweep.listed != 0)
    {
        hold.bound.guard = pair_bounds[i].guard;
        hold.bound.impulse = pair_bounds[i].impulse;
    }
    const PairGuard guard = hold.bound.guard;
    hold.at = displacement(FinePosition(guard.from, unpack_residual(guard.residual)), from);
    hold.swept = displacement(FinePosition(sweep.from, unpack_residual(sweep.residual)), from);
    const float rate = pair_islands[cloth].rate;
    const float clock = pair_islands[cloth].clock;
    const vec3 velocity = carry_velocity(sweep.carry) +
                          (sweep.fall > 0 ? rounded_off(cloth) : vec3(0));
    const vec3 gravity = sweep.fall > 0 ? step_input.gravity : vec3(0);
    const MovingFrame frame = frame_of(cloth);
    const vec3 mean = rate * velocity + pair_islands[cloth].fall_rate * gravity;
    const float last_substep = seconds(push.pair_lasts) / float(push.kicks);
    const float now = clock + rate * (pair_to() - (1 - sweep.fall) * last_substep);
    const vec3 last = rate * (velocity + now * gravity);
    const vec3 carried = clock * velocity + pair_islands[cloth].fall * gravity;
    const float made = pair_islands[cloth].time; // s, from then on to the last pass
    hold.carry = last + frame.motion.velocity;
    hold.carried = (pair_to() - pair_from()) * (mean + frame.motion.velocity);
    hold.at -= pair_from() * (mean + frame.motion.velocity);
    hold.swept -= carried + made * frame.motion.velocity + pair_from() * (mean + frame.motion.velocity);
    const float end = clock + rate * pair_to() + push.pair_ahead * seconds(push.substeps);
    const float list_time = step_input.list_time;
    hold.left = max(end - list_time, 0) * (velocity + list_time * gravity);
    if (is_turning(frame))
    {
        const bool verlet = (cloths[cloth].flags & VOILE_CLOTH_VERLET) != 0;
        const ClockMotion clock_motion = ClockMotion(mean, last, carried + pair_from() * mean);
        turn_with(frame, clock_motion, from, pair_to() - (verlet ? 0.5 * last_substep : 0), made, hold);
    }
    return hold;
}

// Slides along the planes, before colliders stop the vertex.
vec3 along_planes(Hold hold, vec3 motion)
{
    for (uint k = 0; k < 4; ++k)
    {
        const vec4 plane = hold.bound.guard.planes[k & 1u];
        motion -= min(dot(plane.xyz, hold.at - hold.carried + motion) + plane.w * (1 - k_guard_rounding), 0) * plane.xyz;
    }
    return motion;
}

// Whether the guards of a vertex end nearer than it goes on without the clock. Then it would lose its velocity.
bool needs_clock(Hold hold)
{
    const PairGuard guard = hold.bound.guard;
    return length(hold.left) > min(guard.reach, min(guard.planes[0].w, guard.planes[1].w));
}

// Whether the vertex will leave what the lists leave it before they can be made again.
bool wants_lists(Hold hold, vec3 motion)
{
    if (needs_clock(hold))
        return true;
    const float most = k_used_reach * hold.bound.sweep.reach;
    const vec3 ahead = hold.swept + (1 + push.pair_ahead) * (motion - hold.carried) + hold.left;
    return squared_distance_from_segment(ahead, hold.bound.sweep.sweep) >= most * most;
}

// Whether no unlisted pair can have met. Rounding may take a vertex that ends its sweep's reach a little farther.
bool is_in_sweep(Hold hold, vec3 motion)
{
    const float reach = (1 + k_guard_rounding) * hold.bound.sweep.reach;
    return squared_distance_from_segment(hold.swept - hold.carried + motion, hold.bound.sweep.sweep) <= reach * reach;
}

// Where a vertex is within its guards. Each number is negative outside, and grows inwards.
struct Room
{
    vec2 planes; // m
    float ball;  // m
    float sweep; // m^2
};

// `motion`: relative to what carries the vertex.
Room room_at(Hold hold, vec3 motion)
{
    const vec3 d = hold.at + motion;
    const PairGuard guard = hold.bound.guard;
    const float reach = (1 - k_guard_rounding) * hold.bound.sweep.reach;
    Room room;
    room.planes = vec2(dot(d, guard.planes[0].xyz) + guard.planes[0].w, dot(d, guard.planes[1].xyz) + guard.planes[1].w);
    room.ball = (1 - k_guard_rounding) * guard.reach - length(d);
    room.sweep = reach * reach - squared_distance_from_segment(hold.swept + motion, hold.bound.sweep.sweep);
    return room;
}

// Rounding, or what moves vertices that have no mass, may put a vertex outside at the start. It may not go farther out.
bool is_held(Room room, Room start)
{
    return all(greaterThanEqual(room.planes, min(start.planes, 0))) && room.ball >= min(start.ball, 0) &&
           room.sweep >= min(start.sweep, 0);
}

// The part of a motion, relative to what carries the vertex, after which the vertex is still within its guards. The
// guards are convex, and the start of the motion is within them, so bisection finds the end.
float held_part(Hold hold, vec3 motion)
{
    const Room start = room_at(hold, vec3(0));
    if (is_held(room_at(hold, motion), start))
        return 1;
    float low = 0;
    float high = 1;
    for (uint k = 0; k < 12; ++k)
    {
        const float middle = 0.5 * (low + high);
        if (is_held(room_at(hold, middle * motion), start))
            low = middle;
        else
            high = middle;
    }
    return low;
}

#endif
