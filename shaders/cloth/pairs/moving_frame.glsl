// The frame of an island: it moves with the anchors and colliders that restrain the island, and with the island in the
// directions in which none does, so that cloth has the same room between its primitives on a vehicle as at rest, and where it
// slides along a wall.
//
// The including kernel declares pair_islands[] and push (PairPush).
#ifndef VOILE_MOVING_FRAME_GLSL
#define VOILE_MOVING_FRAME_GLSL

#include "pairs/pair_pass.glsl"

// The weight of the island's mean velocity beside that of all restraints.
const float k_mean_weight = 0.02;
// The largest mean square of the speeds of restraints in the frame, as a part of its own. Where they differ by more, as of a
// fast collider beside one at rest, no frame moves with all of them.
const float k_most_deviation = 0.25;

FrameSums no_frame_sums()
{
    FrameSums sums;
    sums.restrained = 0;
    for (uint k = 0; k < VOILE_FRAME_SUMS; ++k)
    {
        sums.low[k] = 0;
        sums.high[k] = 0;
    }
    return sums;
}

float frame_unit(uint sum)
{
    if (sum < VOILE_FRAME_DRIVES)
        return VOILE_FRAME_UNIT_DIRECTION;
    if (sum < VOILE_FRAME_SQUARES)
        return VOILE_FRAME_UNIT_DRIVE;
    return sum == VOILE_FRAME_SQUARES ? VOILE_FRAME_UNIT_SQUARE : VOILE_FRAME_UNIT_SPEED;
}

// Of a workgroup.
int frame_units(float sum, uint k) { return int(clamp(round(sum / frame_unit(k)), -2e9, 2e9)); }

vec3 frame_sums_from(FrameSums sums, uint first)
{
    vec3 result;
    for (uint k = 0; k < 3; ++k)
        result[k] = (65536.0 * float(sums.high[first + k]) + float(sums.low[first + k])) * frame_unit(first + k);
    return result;
}

// m/s, from sums over `vertices`.
vec3 mean_of_sums(FrameSums sums, uint vertices) { return frame_sums_from(sums, VOILE_FRAME_ALL) / float(max(vertices, 1)); }

// m: frames that carry cloth by less until the next pass are not worth new lists.
const float k_least_motion = 1e-4;

bool is_worth_lists(vec3 velocity) { return length(velocity) * pair_interval() >= k_least_motion; }

// s: how long lists with a frame are used, unless a pass takes longer. Restraints that a vertex may reach later do not count.
float frame_horizon() { return max(VOILE_PAIR_SWEEP_TIME, pair_interval()); }

// m/s: least squares of the differences from the restraints, n . (frame - v), and slower if the vertices are, on average.
// `vertices`: of the island.
vec3 velocity_of_frame(FrameSums sums, uint vertices)
{
    if (sums.restrained == 0)
        return vec3(0);
    const vec3 total = frame_sums_from(sums, VOILE_FRAME_DIRECTIONS);
    const float each = 1 / max(total.x + total.y + total.z, VOILE_FRAME_UNIT_DIRECTION);
    const vec3 diagonal = each * total;
    const vec3 beside = each * frame_sums_from(sums, VOILE_FRAME_DIRECTIONS + 3);
    const vec3 drives = each * frame_sums_from(sums, VOILE_FRAME_DRIVES);
    const float squares = each * frame_sums_from(sums, VOILE_FRAME_SQUARES).x;
    const vec3 mean = mean_of_sums(sums, vertices);
    const mat3 directions = mat3(diagonal.x, beside.z, beside.y, beside.z, diagonal.y, beside.x, beside.y, beside.x, diagonal.z);
    const vec3 frame = inverse(directions + k_mean_weight * mat3(1)) * (drives + k_mean_weight * mean);
    const float square = dot(frame, frame);
    const float deviation = squares - 2 * dot(drives, frame) + dot(frame, directions * frame);
    const float part = clamp(dot(mean, frame) / max(square, 1e-30), 0, 1);
    const bool fits = deviation <= k_most_deviation * square;
    return fits && is_worth_lists(part * frame) ? part * frame : vec3(0);
}

void write_frame(uint cloth, FrameSums sums, uint vertices)
{
    const vec3 frame = velocity_of_frame(sums, vertices);
    for (uint k = 0; k < 3; ++k)
        pair_islands[cloth].frame[k] = frame[k];
}

#endif
