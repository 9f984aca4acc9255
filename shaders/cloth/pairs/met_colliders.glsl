// The colliders that vertices of a workgroup may meet as they move (clear.glsl), a bit each: most patches of cloth are far from
// most colliders. Where there are few, all of them.
//
// The including kernel includes clear.glsl and fold.glsl, and defines k_unbounded.
#ifndef VOILE_MET_COLLIDERS_GLSL
#define VOILE_MET_COLLIDERS_GLSL

#include "colliders/swept_box.glsl"
#include "pairs/moving_frame.glsl"

const uint k_few_colliders = 8;
const float k_diagonal = 1.7320508; // of a cube: boxes are grown in the space of a collider

shared Box shared_swept; // around all displacements, with their margins; nothing overlaps it if no vertex moves
shared uint shared_met[(gl_WorkGroupSize.x + 31) / 32];

bool are_few() { return push.colliders <= k_few_colliders; }

// Of the workgroup; by all threads. `moves`: whether the vertex does.
void find_swept_box(uint thread, bool moves, Way way)
{
    if (are_few())
        return;
    const float farthest = k_diagonal * max(way.margin, way.near) + way.time * length(way.v);
    float corners[k_values]; // the lower one negated
    for (uint k = 0; k < k_values; ++k)
        corners[k] = -k_unbounded;
    for (uint k = 0; k < 3 && moves; ++k)
    {
        corners[k] = farthest - way.x[k];
        corners[3 + k] = farthest + way.x[k];
    }
    fold(thread, 0, corners);
    if (thread == 0)
        shared_swept = Box(-vec3(corners[0], corners[1], corners[2]), vec3(corners[3], corners[4], corners[5]));
    barrier();
}

// m: how much nearer the motion of a collider brings it than the box says that it sweeps (relative_way).
float motion_margin(uint c, Box swept)
{
    const vec3 apart = max(abs(swept.max - shared_swept.min), abs(shared_swept.max - swept.min));
    const float farthest = length(apart) + length(shared_swept.max - shared_swept.min);
    const float steps = max(1, step_input.list_time * step_input.rate);
    return k_diagonal * steps * motion_at(collider_motions[c], vec3(farthest));
}

bool may_meet(uint c, ColliderRecord collider)
{
    if (are_few() || collider.kind == VOILE_COLLIDER_PLANE)
        return true;
    const Box swept = swept_box(c, collider);
    const float rounding = k_near_rounding * length(max(abs(shared_swept.min), abs(shared_swept.max)));
    const float motion = is_moved(collider.flags) ? motion_margin(c, swept) : 0;
    return overlap(grown(swept, rounding + motion), shared_swept);
}

// Of the colliders from `first` on, as many as there are threads. By all threads.
void find_met(uint first, uint thread, uint layers)
{
    barrier();
    if (thread < shared_met.length())
        shared_met[thread] = 0;
    barrier();
    const uint c = first + thread;
    if (c < push.colliders && (colliders[c].layers & layers) != 0 && may_meet(c, colliders[c]))
        atomicOr(shared_met[thread / 32], 1u << (thread % 32));
    barrier();
}

// A walk over what find_met has found, in one loop: CPU devices execute each loop once at least.
struct MetWalk
{
    uint word; // the next one
    uint bits; // the rest of the word before it
};

MetWalk walk_met(bool moves) { return MetWalk(moves ? 0 : shared_met.length(), 0); }

// `c`: from the first collider on.
bool next_met(inout MetWalk walk, out uint c)
{
    while (walk.bits == 0 && walk.word < shared_met.length())
        walk.bits = shared_met[walk.word++];
    c = 32 * (walk.word - 1) + uint(findLSB(walk.bits));
    const bool found = walk.bits != 0;
    walk.bits &= walk.bits - 1;
    return found;
}

#endif
