// What the threads of one vertex found, in shared memory: first the responses of all, then one guard after the other in the
// same place.
//
// The including kernel includes feature_guard.glsl before. A barrier must separate storing from reading.
#ifndef VOILE_FEATURE_LANES_GLSL
#define VOILE_FEATURE_LANES_GLSL

const uint k_lane_words = 5;
// Per thread of the workgroup. Threads of one vertex are adjacent.
shared vec4 lanes[k_lane_words * gl_WorkGroupSize.x];

void store_response(uint thread)
{
    const float collider = response.collider == k_no_collider ? -1 : float(response.collider);
    lanes[k_lane_words * thread] = vec4(response.shift, response.pressed);
    lanes[k_lane_words * thread + 1] = vec4(response.change, collider);
    lanes[k_lane_words * thread + 2] = vec4(response.slowing, response.impulses);
    lanes[k_lane_words * thread + 3] = vec4(response.motion.carried, 0);
    lanes[k_lane_words * thread + 4] = vec4(response.motion.turned, 0);
}

Response stored_response(uint thread)
{
    const vec4 change = lanes[k_lane_words * thread + 1];
    const vec4 slowing = lanes[k_lane_words * thread + 2];
    const FeatureMotion motion =
        FeatureMotion(lanes[k_lane_words * thread + 3].xyz, lanes[k_lane_words * thread + 4].xyz);
    return Response(lanes[k_lane_words * thread].xyz, lanes[k_lane_words * thread].w, change.xyz,
                    change.w < 0 ? k_no_collider : uint(change.w), slowing.xyz, motion, slowing.w);
}

// The guard of this thread, where the responses of two threads from `thread` on were.
void store_guard(uint thread)
{
    const uint first = k_lane_words * thread;
    for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        lanes[first + k] = guard.planes[k];
    lanes[first + VOILE_GUARD_PLANES] = vec4(guard.carried, guard.least);
    lanes[first + VOILE_GUARD_PLANES + 1] = slacks;
    lanes[first + VOILE_GUARD_PLANES + 2] = vec4(guard.reach, least_slack, 0, 0);
}

void merge_stored_guard(uint thread)
{
    const uint first = k_lane_words * thread;
    FeatureGuard other;
    for (uint k = 0; k < VOILE_GUARD_PLANES; ++k)
        other.planes[k] = lanes[first + k];
    other.carried = lanes[first + VOILE_GUARD_PLANES].xyz;
    other.least = lanes[first + VOILE_GUARD_PLANES].w;
    other.reach = lanes[first + VOILE_GUARD_PLANES + 2].x;
    merge_guard(other, lanes[first + VOILE_GUARD_PLANES + 1], lanes[first + VOILE_GUARD_PLANES + 2].y);
}

#endif
