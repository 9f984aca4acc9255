// A vertex's walk over the colliders near its patch.
//
// A character has many colliders, of which a vertex is near few. Where there are lists, the workgroup loads the bounding
// spheres of its patch's colliders together first: a thread that loaded one after the other would wait for each. Threads
// that run together then find the next collider near them in a short loop each, before they respond together.
//
// The including kernel declares colliders[], collider_motions[], patch_of_group(), push (ContactPush) and the constants
// COLLIDERS_CONVEX and NEAR_LISTS, and includes near_colliders.glsl, contact_candidates.glsl and convex.glsl before.
#ifndef VOILE_NEAR_WALK_GLSL
#define VOILE_NEAR_WALK_GLSL

// Over the distance at which a query may find something: room for rounding.
const float k_beyond = 1.0001;
const float k_no_sphere = 3e38;

// The sphere around a collider with a formula. Planes and meshes have none.
struct ColliderBound
{
    vec3 origin;  // m, world
    vec3 start;   // m, of the center from there, at the substep's start
    vec3 end;     // m, at its end
    float radius; // m; k_no_sphere: there is no sphere
};

ColliderBound bound_of(uint c)
{
    const uint kind = colliders[c].kind;
    ColliderBound bound = ColliderBound(colliders[c].origin, vec3(0), vec3(0), k_no_sphere);
    if (kind == VOILE_COLLIDER_MESH || kind == VOILE_COLLIDER_PLANE)
        return bound;
    bound.radius = bounding_radius(kind, colliders[c].shape);
    if (is_moved(colliders[c].flags))
    {
        bound.origin = collider_motions[c].origin;
        bound.start = origin_at(c, push.progress_from);
        bound.end = origin_at(c, push.progress_to);
    }
    return bound;
}

// Whether the path stays outside of the sphere.
bool passes_by(ColliderBound bound, Motion motion, float thickness)
{
    if (bound.radius == k_no_sphere)
        return false;
    precise const vec3 offset = motion.from.x - bound.origin + motion.from.residual;
    const vec3 from = offset - bound.start;
    const vec3 to = offset + motion.displacement - bound.end;
    const float nearest = 0.5 * (length(from + to) - distance(from, to));
    const float radius = query_radius(thickness) + max(rounding(from), rounding(to));
    return nearest > k_beyond * (bound.radius + radius);
}

// The colliders listed for the patch, in their order.
const uint k_most_staged = 32;
const uint k_not_staged = 0xffffffffu;
shared uint staged_count; // k_not_staged: there is no list, or it is longer
shared uint staged_colliders[k_most_staged];
shared vec4 staged_origins[k_most_staged]; // w: radius
shared vec4 staged_starts[k_most_staged];
shared vec4 staged_ends[k_most_staged];
shared uint word_counts[gl_WorkGroupSize.x]; // bits of each word of the list

ColliderBound staged_bound(uint position)
{
    return ColliderBound(staged_origins[position].xyz, staged_starts[position].xyz, staged_ends[position].xyz,
                         staged_origins[position].w);
}

// The colliders of a word of the list, at their positions among all.
void stage_word(uint word, uint bits)
{
    uint position = 0;
    for (uint i = 0; i < gl_LocalInvocationID.x; ++i)
        position += word_counts[i];
    for (; bits != 0 && position < k_most_staged; bits &= bits - 1)
        staged_colliders[position++] = 32 * word + uint(findLSB(bits));
    if (gl_LocalInvocationID.x + 1 == gl_WorkGroupSize.x)
        staged_count = position + bitCount(bits) <= k_most_staged ? position : k_not_staged;
}

// All threads of the workgroup call it.
void stage_colliders()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint header = patch_of_group() * push.near_stride;
    const uint first = near_colliders[header + VOILE_NEAR_FIRST];
    const uint end = near_colliders[header + VOILE_NEAR_END];
    const bool fits = end - first <= gl_WorkGroupSize.x; // a thread per word
    const uint bits = fits && thread < end - first ? near_colliders[header + VOILE_NEAR_WORDS + first + thread] : 0;
    word_counts[thread] = bitCount(bits);
    barrier();
    stage_word(first + thread, bits);
    barrier();
    if (!fits)
        staged_count = k_not_staged;
    else if (thread < staged_count && staged_count <= k_most_staged)
    {
        const ColliderBound bound = bound_of(staged_colliders[thread]);
        staged_origins[thread] = vec4(bound.origin, bound.radius);
        staged_starts[thread] = vec4(bound.start, 0);
        staged_ends[thread] = vec4(bound.end, 0);
    }
    barrier();
}

struct NearWalk
{
    ColliderWalk all;
    bool staged;
    uint next; // position
};

NearWalk walk_path(Motion motion)
{
    const ColliderWalk all = walk_colliders(patch_of_group(), box_around(motion.from.x, position_of(motion)));
    const bool staged = NEAR_LISTS != 0 && all.first != k_all_colliders && staged_count <= k_most_staged;
    return NearWalk(all, staged, 0);
}

bool next_of_walk(inout NearWalk walk, out uint c)
{
    if (!walk.staged)
        return next_collider(walk.all, c);
    const bool found = walk.next < staged_count;
    c = found ? staged_colliders[walk.next++] : 0;
    return found;
}

// Whether the path misses the collider that was found last.
bool misses(NearWalk walk, uint c, Motion motion, float thickness)
{
    if (COLLIDERS_CONVEX == 0)
        return false;
    ColliderBound bound;
    if (walk.staged)
        bound = staged_bound(walk.next - 1);
    else
        bound = bound_of(c);
    return passes_by(bound, motion, thickness);
}

// The next collider that may change the motion. `leaves_solid`: none that is solid.
bool next_near(inout NearWalk walk, out uint c, Motion motion, float thickness, bool leaves_solid)
{
    bool found = next_of_walk(walk, c);
    while (found && (misses(walk, c, motion, thickness) || (leaves_solid && is_solid(colliders[c]))))
        found = next_of_walk(walk, c);
    return found;
}

// After collider c has moved the vertex.
void continue_walk(inout NearWalk walk, uint c, Motion motion)
{
    continue_walk(walk.all, c, position_of(motion));
    walk.staged = walk.staged && walk.all.first != k_all_colliders;
}

#endif
