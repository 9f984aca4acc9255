// Lists of the triangles near each vertex, kept from substep to substep.
//
// A traversal collects all triangles within a ball around the vertex. The ball is wider than one substep needs by a
// margin. While the vertex stays within the margin, the next substeps test only these triangles, and skip those whose
// stored distance is too large. A dispatch waits for its slowest thread: for one long list, or for one traversal.
// Therefore:
//   - all lists are refreshed together, every VOILE_RENEWAL substeps, if half of their margin is used up;
//   - the ball shrinks while triangles are found, so that the list stays short;
//   - a vertex with more triangles than fit without any margin traverses in every substep, and refreshes try again.
// The list of a moving collider is relative to the collider's position when the list was made. It holds until the end
// of that step. So does the list of a deforming mesh, whose boxes cover the whole step.
// The including kernel declares candidate_places[] and candidate_triangles[] and includes contact_query.glsl,
// collider_pose.glsl and near_colliders.glsl before.
#ifndef VOILE_CONTACT_CANDIDATES_GLSL
#define VOILE_CONTACT_CANDIDATES_GLSL

// The margin of a vertex at rest, as a fraction of the thickness.
const float k_candidate_margin = 0.5;
// The query radius of contact over the thickness: room for the rounding of distances.
const float k_query_radius = 1.001;
// The ball shrinks while the list is at least this long. The next list's margin may be larger by the growth factor.
const uint k_aimed_count = 11;
const float k_margin_growth = 1.5;
// A margin below this fraction of the ball's radius is not shrunk to shorten the list.
const float k_lasting_margin = 0.03;

// Words of the list: the head with its length; the largest and the least radius of the ball; then the entries. An entry
// is a triangle, or a slot of an implicit BVH, with its distance from the ball's center as a level between both radii.
// Levels are finest near the least radius: where many triangles are near, they decide which of them the ball must hold.
const uint k_head_word = 0;
const uint k_radius_word = 1;
const uint k_least_word = 2;
const uint k_first_entry = 3;
const uint k_slot_bit = 0x80000000u; // the entry is a slot
const uint k_levels = 31;
const uint k_triangle_mask = (1u << VOILE_CANDIDATE_TRIANGLE_BITS) - 1;

struct Candidates
{
    uint vertex;
    uint count;   // VOILE_CANDIDATES + 1: more than fit
    vec3 center;  // m, world: the query center, middle of the ball that the list covers
    float radius; // m, of the ball
    float wished; // m, the largest radius
    float least;  // m, the least radius
    float made;   // progress of the step when the list was made; < 0: in an earlier step
    // Of the mesh that is being traversed to collect.
    vec3 local_center;  // m, the query center in the mesh's space
    uint kind;          // k_slot_bit if it deforms, else 0
    uvec2 first_corner; // as in MeshQuery
};
Candidates candidates;

// Word-major order: neighboring threads read the same word at the same time.
uint candidate_word(uint word) { return word * push.vertices + candidates.vertex; }

// Loaded only where the list is read or made. For most vertices it is neither.
void load_radii()
{
    candidates.wished = uintBitsToFloat(candidate_triangles[candidate_word(k_radius_word)]);
    candidates.least = uintBitsToFloat(candidate_triangles[candidate_word(k_least_word)]);
}

// m: a lower bound of an entry's distance from the query center.
float entry_distance(uint entry)
{
    const float level = float(entry >> VOILE_CANDIDATE_TRIANGLE_BITS & k_levels) / k_levels;
    return level > 0 ? candidates.least + level * level * (candidates.wished - candidates.least) : 0;
}

uint level_of(float distance)
{
    const float at_least = 0.9999 * distance - rounding(candidates.local_center);
    const float fraction = (at_least - candidates.least) / (candidates.wished - candidates.least);
    return uint(sqrt(clamp(fraction, 0, 1)) * k_levels);
}

// Shrinks the ball until the list is short, while a lasting margin is left. A full list shrinks further, until it has
// room or the levels of its entries differ no more.
void shrink_ball()
{
    const float least_spare = (candidates.wished - candidates.least) / (k_levels * k_levels);
    while (candidates.count >= k_aimed_count)
    {
        const float spare = candidates.radius - candidates.least;
        const bool has_room = candidates.count < VOILE_CANDIDATES;
        if (spare < (has_room ? k_lasting_margin * candidates.wished : least_spare))
            return;
        const float radius = candidates.least + 0.5 * spare;
        if (radius >= candidates.radius)
            return; // by rounding
        candidates.radius = radius;
        uint kept = 0;
        for (uint i = 0; i < candidates.count; ++i)
        {
            const uint entry = candidate_triangles[candidate_word(k_first_entry + i)];
            if (entry_distance(entry) <= candidates.radius)
                candidate_triangles[candidate_word(k_first_entry + kept++)] = entry;
        }
        candidates.count = kept;
    }
}

// m, from the query center. For a triangle that deforms a lower bound over the whole step: the triangle is never
// farther from its halfway position than half of its corners' longest displacement.
float triangle_distance(uint triangle)
{
    if (COLLIDERS_MOVE == 0 || candidates.kind == 0)
    {
        const BvhTriangle t = bvh_triangles[triangle];
        return distance(candidates.local_center, nearest_on_triangle(candidates.local_center, t.a, t.b, t.c));
    }
    const MovingTriangle t = moving_triangle(triangle, candidates.first_corner, vec2(0, 1));
    const float longest = max(max(distance(t.start.a, t.end.a), distance(t.start.b, t.end.b)), distance(t.start.c, t.end.c));
    const vec3 nearest = nearest_on_triangle(candidates.local_center, 0.5 * (t.start.a + t.end.a), 0.5 * (t.start.b + t.end.b),
                                             0.5 * (t.start.c + t.end.c));
    return max(distance(candidates.local_center, nearest) - 0.5 * longest, 0);
}

void collect_triangle(uint triangle)
{
    if (candidates.count > VOILE_CANDIDATES)
        return;
    const float distance = triangle_distance(triangle);
    if (distance <= candidates.radius)
        shrink_ball();
    if (distance > candidates.radius)
        return;
    if (candidates.count < VOILE_CANDIDATES)
    {
        candidate_triangles[candidate_word(k_first_entry + candidates.count)] =
            candidates.kind | level_of(distance) << VOILE_CANDIDATE_TRIANGLE_BITS | triangle;
    }
    ++candidates.count;
}

// A traversal of a mesh, either to collect candidates or to visit triangles.
struct MeshTraversal
{
    bool collect;
    Box box;
};

void visit_leaf(inout MeshTraversal traversal, uint first, uint count)
{
    for (uint t = first; t < first + count; ++t)
    {
        if (traversal.collect)
            collect_triangle(t);
        else
            visit_triangle(t);
    }
}

// Whether a traversal enters a node's box. To collect: if the box touches the ball, which shrinks meanwhile; never once
// the list has overflowed. Else: if the box may hold something closer than the nearest so far, or overlaps the vertex's
// path. Boxes of a deforming mesh cover its motion within the step, so the path alone decides there, too.
bool enters_node(MeshTraversal traversal, Box node)
{
    if (traversal.collect)
        return candidates.count <= VOILE_CANDIDATES &&
               distance(candidates.local_center, clamp(candidates.local_center, node.min, node.max)) <= candidates.radius;
    const float nearest = query.distance + 10 * query_tie() + rounding(query.to);
    return overlap(traversal.box, node) &&
           (distance(query.to, clamp(query.to, node.min, node.max)) <= nearest ||
            overlap(box_around(query.from, query.to), node));
}

#define VOILE_QUERY MeshTraversal
#include "colliders/bvh.glsl"
#include "colliders/padded.glsl"
#undef VOILE_QUERY

void traverse(MeshTraversal traversal, ColliderRecord collider)
{
    if (is_deforming(collider.flags))
        traverse_padded(traversal, collider.first_node, collider.first_triangle, collider.triangles);
    else
        traverse_bvh(traversal, collider.first_node, collider.first_triangle);
}

// The query center in the space of collider c.
vec3 local_query_center(uint c, uint flags)
{
    return into_collider(c, flags, FinePosition(candidates.center, vec3(0)), candidates.made);
}

// m: the radius of the smallest ball around the query center that holds the path from `from` to `to` and a ball of
// `query_radius` around its end. Both are in the space of collider c.
float needed_radius(uint c, uint flags, vec3 from, vec3 to, float query_radius)
{
    if (candidates.made < 0 && (is_moved(flags) || is_deforming(flags)))
        return 3e38;
    const vec3 center = local_query_center(c, flags);
    return max(distance(center, from), distance(center, to) + query_radius);
}

bool belongs(uint entry, ColliderRecord collider, uint kind)
{
    const uint triangle = entry & k_triangle_mask;
    return (entry & k_slot_bit) == kind && triangle >= collider.first_triangle &&
           triangle < collider.first_triangle + collider.triangles;
}

void visit_mesh(uint c, ColliderRecord collider, Box box)
{
    const uint kind = is_deforming(collider.flags) ? k_slot_bit : 0;
    const float needed = needed_radius(c, collider.flags, query.from, query.to, query.thickness);
    if (candidates.count > VOILE_CANDIDATES || needed > candidates.radius)
    {
        traverse(MeshTraversal(false, box), collider);
        return;
    }
    load_radii();
    uint next = candidate_triangles[candidate_word(k_first_entry)]; // loaded one ahead, while the current one is tested
    for (uint i = 0; i < candidates.count; ++i)
    {
        const uint entry = next;
        next = candidate_triangles[candidate_word(k_first_entry + min(i + 1, VOILE_CANDIDATES - 1))];
        if (entry_distance(entry) <= needed && belongs(entry, collider, kind))
            visit_triangle(entry & k_triangle_mask);
    }
}

// Whether the list covers every moving mesh that is near. `carried`: m, raised to the longest displacement that a mesh
// gives its surface here.
bool covers_moving(FinePosition from, vec3 displacement, float query_radius, inout float carried)
{
    if (COLLIDERS_MOVE == 0)
        return true;
    bool covers = true;
    const vec3 to = from.x + displacement;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, box_around(from.x, to));
    uint c;
    while (next_collider(walk, c))
    {
        const uint flags = colliders[c].flags;
        if (!(is_moved(flags) || is_deforming(flags)) || colliders[c].kind != VOILE_COLLIDER_MESH)
            continue;
        vec3 a = from_origin(c, flags, from);
        vec3 b = a + displacement;
        float shift = 0;
        if (is_moved(flags))
        {
            const vec3 end = b;
            const Pose start = pose_at(c, push.progress_from);
            a = to_collider(start, a);
            b = to_collider(pose_at(c, push.progress_to), end);
            shift = distance(to_world(start, b), end);
        }
        if (!overlaps_mesh(colliders[c], grown(box_around(a, b), query_radius)))
            continue;
        carried = max(carried, shift);
        covers = covers && needed_radius(c, flags, a, b, query_radius) <= candidates.radius;
    }
    return covers;
}

void collect_triangles()
{
    candidates.count = 0;
    ColliderWalk walk =
        walk_colliders(gl_WorkGroupID.x, grown(Box(candidates.center, candidates.center), candidates.radius));
    uint c;
    while (next_collider(walk, c))
    {
        const ColliderRecord collider = colliders[c];
        if (collider.kind != VOILE_COLLIDER_MESH)
            continue;
        candidates.local_center = local_query_center(c, collider.flags);
        candidates.kind = 0;
        if (is_deforming(collider.flags))
        {
            candidates.kind = k_slot_bit;
            candidates.first_corner = uvec2(collider_motions[c].first_from, collider_motions[c].first_to);
        }
        const Box box = grown(Box(candidates.local_center, candidates.local_center), candidates.radius);
        if (overlaps_mesh(collider, box))
            traverse(MeshTraversal(true, box), collider);
    }
}

// Makes a new list. `path`: m, the longest distance of this substep's path from the query center; `margin`: m, beyond
// that;
// `query_radius`: m, of contact around the vertex.
void refresh_candidates(float path, float margin, float query_radius)
{
    // If the last ball shrank, this one is only a little wider: what lies farther out would be dropped again.
    const float last = candidates.radius - query_radius;
    const bool shrank = last >= 0 && candidates.radius < candidates.wished;
    const float grown = max(k_margin_growth * last, 0.1 * k_candidate_margin * query_radius);
    candidates.least = query_radius + path;
    candidates.wished = candidates.least + (shrank ? min(margin, grown) : margin);
    candidates.radius = candidates.wished;
    collect_triangles();
    if (candidates.count > VOILE_CANDIDATES)
        candidates.radius = candidates.wished; // until the next refresh, which would find as many
    candidate_places[candidates.vertex] = vec4(candidates.center, candidates.radius);
    candidate_triangles[candidate_word(k_head_word)] =
        push.substep << VOILE_CANDIDATE_COUNT_BITS | candidates.count;
    candidate_triangles[candidate_word(k_radius_word)] = floatBitsToUint(candidates.wished);
    candidate_triangles[candidate_word(k_least_word)] = floatBitsToUint(candidates.least);
}

// m: the longest distance of the path from the query center.
float path_distance(vec3 center, FinePosition from, vec3 displacement)
{
    const vec3 offset = from.x - center + from.residual;
    return max(length(offset), length(offset + displacement));
}

// Loads the vertex's list. Makes a new one if that does not cover the displacement (m) from `from`.
void update_candidates(uint vertex, FinePosition from, vec3 displacement, vec3 velocity, float thickness)
{
    candidates.vertex = vertex;
    const vec4 ball = candidate_places[vertex]; // w: m, the radius; < 0: there is no list
    const uint head = candidate_triangles[candidate_word(k_head_word)];
    const float query_radius = k_query_radius * thickness + rounding(vec3(push.mesh_extent));
    const uint made = head >> VOILE_CANDIDATE_COUNT_BITS;
    candidates.count = head & VOILE_CANDIDATE_COUNT_MASK;
    candidates.center = ball.xyz;
    candidates.radius = ball.w;
    candidates.made = made < push.first_substep
                          ? -1
                          : min(float(made - push.first_substep + 1) * push.progress_a_substep, 1);
    const float margin = ball.w - query_radius; // below 0 if the cloth has become thicker
    const float usable = push.renew == 1 ? 0.5 * margin : margin;
    const bool covers = path_distance(ball.xyz, from, displacement) <= usable;
    float carried = 0;
    const bool covers_all = covers_moving(from, displacement, query_radius, carried);
    const float speed = length(velocity) + carried / push.step;
    const float wanted = max(k_candidate_margin * thickness, 2 * speed * push.renewal_time);
    // A list that overflowed when the vertex was fast, or too close, may fit when it rests.
    const bool may_fit = push.renew == 1 && candidates.count > VOILE_CANDIDATES;
    if (covers && covers_all && !may_fit)
        return;
    candidates.center = from.x + 0.5 * displacement;
    candidates.made = push.progress_to;
    load_radii();
    refresh_candidates(path_distance(candidates.center, from, displacement) + carried, wanted, query_radius);
}

#endif
