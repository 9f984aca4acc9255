// The frame of an island: it moves and turns with the anchors and colliders that restrain the island, and with the island in the
// directions in which none does, so that cloth has the same room between its primitives on a vehicle or on a dancer as at rest,
// and where it slides along a wall or in a pipe.
//
// The including kernel declares pair_islands[] and push (PairPush).
#ifndef VOILE_MOVING_FRAME_GLSL
#define VOILE_MOVING_FRAME_GLSL

#include "pairs/frame_sums.glsl"
#include "pairs/pair_pass.glsl"
#include "shared/finite.glsl"

// The weight of the island's mean motion beside that of all restraints.
const float k_mean_weight = 0.02;
// The largest mean square of the speeds of restraints in the frame, as a part of the frame's own. Where they differ by more, as of a
// fast collider beside one at rest, no frame moves with all of them.
const float k_most_deviation = 0.25;
// A frame turns if that leaves less than this part of the mean square that restraints have in one that does not.
const float k_most_left = 0.7;
// m: frames that carry cloth by less until the next pass are not worth new lists.
const float k_least_motion = 1e-4;

bool is_worth_lists(float mean_square) { return sqrt(max(mean_square, 0)) * pair_interval() >= k_least_motion; }

// Means over restraints (pair_layout.h).
struct RestraintMeans
{
    mat3 directions;
    mat3 mixed;
    mat3 turns;
    vec3 drives;
    vec3 moments;
    float squares;
};

RestraintMeans restraints_of(float sums[VOILE_FRAME_SUMS])
{
    const float total = sums[VOILE_FRAME_DIRECTIONS] + sums[VOILE_FRAME_DIRECTIONS + 1] + sums[VOILE_FRAME_DIRECTIONS + 2];
    const float each = 1 / max(total, VOILE_FRAME_UNIT_DIRECTION);
    return RestraintMeans(
        each * symmetric_from(sums, VOILE_FRAME_DIRECTIONS), each * matrix_from(sums, VOILE_FRAME_MIXED),
        each * symmetric_from(sums, VOILE_FRAME_TURNS), each * sums_from(sums, VOILE_FRAME_DRIVES),
        each * sums_from(sums, VOILE_FRAME_MOMENTS), each * sums[VOILE_FRAME_SQUARES]);
}

MeanMotion mean_motion(float sums[VOILE_FRAME_SUMS], uint vertices)
{
    const float each = 1 / float(max(vertices, 1));
    return MeanMotion(each * sums_from(sums, VOILE_FRAME_VELOCITIES), each * sums_from(sums, VOILE_FRAME_POSITIONS),
                      each * sums_from(sums, VOILE_FRAME_SPINS), each * symmetric_from(sums, VOILE_FRAME_SPREADS));
}

// m^2/s^2: the mean square of the restraints' speeds in a frame.
float deviation(RestraintMeans of, RigidMotion frame)
{
    const vec3 v = frame.velocity;
    const vec3 w = frame.angular_velocity;
    return of.squares - 2 * (dot(of.drives, v) + dot(of.moments, w)) + dot(v, of.directions * v) +
           2 * dot(v, of.mixed * w) + dot(w, of.turns * w);
}

// Whether the restraints move with a frame.
bool is_common(RestraintMeans restraints, MeanMotion mean, RigidMotion frame)
{
    return deviation(restraints, frame) <= k_most_deviation * mean_square(mean, frame);
}

const RigidMotion k_at_rest = RigidMotion(vec3(0), vec3(0));

// Slower if the vertices are, on average. At rest if it is not worth lists.
RigidMotion slowed(RigidMotion frame, MeanMotion mean)
{
    const float square = mean_square(mean, frame);
    const float along = dot(mean.velocity, frame.velocity) + dot(mean.spin, frame.angular_velocity);
    const float part = clamp(along / max(square, 1e-30), 0, 1);
    if (!is_worth_lists(part * part * square))
        return k_at_rest;
    return RigidMotion(part * frame.velocity, part * frame.angular_velocity);
}

// Least squares of the differences from the restraints, n . (v + w x r) - d, and a little of those from the vertices'
// motion. A frame that does not turn, unless that is better by a speed which is worth lists: on uneven ground, or under cloth
// that tumbles, it would follow what is no rotation.
RigidMotion motion_of_frame(RestraintMeans restraints, MeanMotion mean)
{
    const mat3 directions = inverse(restraints.directions + k_mean_weight * mat3(1));
    const mat3 mixed = restraints.mixed - k_mean_weight * cross_matrix(mean.position);
    const mat3 turns = restraints.turns + k_mean_weight * inertia_of(mean.spread);
    const vec3 drives = restraints.drives + k_mean_weight * mean.velocity;
    const vec3 moments = restraints.moments + k_mean_weight * mean.spin;
    const RigidMotion straight = RigidMotion(directions * drives, vec3(0));
    const mat3 reduced = turns - transpose(mixed) * directions * mixed + k_least_inertia * trace(turns) * mat3(1);
    const vec3 w = inverse(reduced) * (moments - transpose(mixed) * straight.velocity);
    const RigidMotion turning = RigidMotion(directions * (drives - mixed * w), w);
    const float gain = dot(drives, turning.velocity - straight.velocity) + dot(moments, w);
    const bool explains = deviation(restraints, turning) <= k_most_left * deviation(restraints, straight);
    if (explains && is_worth_lists(gain) && is_common(restraints, mean, turning))
        return slowed(turning, mean);
    return is_common(restraints, mean, straight) ? slowed(straight, mean) : k_at_rest;
}

void write_frame(uint cloth, RigidMotion frame)
{
    for (uint k = 0; k < 3; ++k)
    {
        pair_islands[cloth].frame[k] = frame.velocity[k];
        pair_islands[cloth].frame_turn[k] = frame.angular_velocity[k];
    }
}

// `restrained`: vertices, and `vertices`: of the island.
RigidMotion frame_from(uint restrained, float sums[VOILE_FRAME_SUMS], uint vertices)
{
    if (restrained == 0)
        return k_at_rest;
    const RigidMotion frame = motion_of_frame(restraints_of(sums), mean_motion(sums, vertices));
    return is_finite(frame.velocity) && is_finite(frame.angular_velocity) ? frame : k_at_rest;
}

#endif
