// The triangles near a vertex, kept from substep to substep.
//
// A traversal finds all triangles within a ball around the vertex that is wider by a margin than a substep needs. As long as
// the vertex stays within that margin, the following substeps test these triangles alone, and of them those which may be near
// enough by the distance that the list tells. A dispatch waits for its slowest thread, for one long list and for any traversal:
//   - lists are renewed together, every VOILE_RENEWAL substeps, by all vertices that have used up half of their margin;
//   - the margin narrows while triangles are found, so that the list stays short;
//   - where more are near than the list holds with no margin at all, every substep traverses, and renewals try again.
// A moving collider has the list of the place where the vertex was, in the collider's space, when the list was made; it holds
// within the step in which that was. So does the list of a deforming one, whose boxes cover all of the step.
// The including kernel declares candidate_places[] and candidate_triangles[] and includes contact_query.glsl,
// collider_pose.glsl and near_colliders.glsl before.
#ifndef VOILE_CONTACT_CANDIDATES_GLSL
#define VOILE_CONTACT_CANDIDATES_GLSL

// The margin, as a share of the thickness, that a vertex at rest has.
#define VOILE_CANDIDATE_MARGIN 0.5
// How far contact looks, as a share of the thickness: it, and the roundings of distances.
#define VOILE_CANDIDATE_REACH 1.001
// The margin narrows where a list would be longer, and after that grows again by this factor from list to list.
#define VOILE_CANDIDATE_AIM 11
#define VOILE_CANDIDATE_GROWTH 1.5
// A margin of this share of the ball's radius is worth more than a list that short.
#define VOILE_CANDIDATE_LASTING 0.03

// Words of the list: its head, with its length; the radius that it was to have, and that it must have; then entries: the
// triangle, or the slot of a padded tree, and how far it is from the middle of the ball between these two radii. Its steps are
// finest near the smaller one: where many triangles are near, a little there tells which of them the ball must have.
#define VOILE_CANDIDATE_HEAD 0
#define VOILE_CANDIDATE_RADIUS 1
#define VOILE_CANDIDATE_LEAST 2
#define VOILE_CANDIDATE_ENTRIES 3
#define VOILE_CANDIDATE_SLOT 0x80000000u // the entry is a slot
#define VOILE_CANDIDATE_LEVELS 31
#define VOILE_CANDIDATE_TRIANGLE_MASK ((1u << VOILE_CANDIDATE_TRIANGLE_BITS) - 1)

struct Candidates
{
    uint vertex;
    uint count;   // VOILE_CANDIDATES + 1: more than fit
    bool collect; // take_leaf puts triangles into the list; else it visits them
    vec3 place;   // m, world: the middle of the ball that the list covers
    float cover;  // m, radius of the ball
    float wished; // m, that it was to have
    float least;  // m, that it must have
    float made;   // progress of the step when the list was made; < 0: in a step before
    // Of the mesh that is traversed to collect
    vec3 middle;        // m, of the ball in its space
    uint kind;          // VOILE_CANDIDATE_SLOT if it deforms, else 0
    uvec2 first_corner; // as in MeshQuery
};
Candidates candidates;

// Neighboring threads read the same word at the same time: word after word, not vertex after vertex.
uint candidate_word(uint word) { return word * push.vertices + candidates.vertex; }

// Where the list is read or made anew: for most vertices it is neither.
void load_radii()
{
    candidates.wished = uintBitsToFloat(candidate_triangles[candidate_word(VOILE_CANDIDATE_RADIUS)]);
    candidates.least = uintBitsToFloat(candidate_triangles[candidate_word(VOILE_CANDIDATE_LEAST)]);
}

// m, at least: how far an entry is from the middle of the ball.
float entry_distance(uint entry)
{
    const float level = float(entry >> VOILE_CANDIDATE_TRIANGLE_BITS & VOILE_CANDIDATE_LEVELS) / VOILE_CANDIDATE_LEVELS;
    return level > 0 ? candidates.least + level * level * (candidates.wished - candidates.least) : 0;
}

uint level_of(float distance)
{
    const float at_least = 0.9999 * distance - rounding(candidates.middle);
    const float share = (at_least - candidates.least) / (candidates.wished - candidates.least);
    return uint(sqrt(clamp(share, 0, 1)) * VOILE_CANDIDATE_LEVELS);
}

// Narrows the ball until the list is short, as long as that leaves a margin that lasts. A list that is full narrows on, until it
// has room or entries tell their distances no finer.
void narrow()
{
    const float least_spare = (candidates.wished - candidates.least) / (VOILE_CANDIDATE_LEVELS * VOILE_CANDIDATE_LEVELS);
    while (candidates.count >= VOILE_CANDIDATE_AIM)
    {
        const float spare = candidates.cover - candidates.least;
        const bool has_room = candidates.count < VOILE_CANDIDATES;
        if (spare < (has_room ? VOILE_CANDIDATE_LASTING * candidates.wished : least_spare))
            return;
        const float cover = candidates.least + 0.5 * spare;
        if (cover >= candidates.cover)
            return; // by rounding
        candidates.cover = cover;
        uint kept = 0;
        for (uint i = 0; i < candidates.count; ++i)
        {
            const uint entry = candidate_triangles[candidate_word(VOILE_CANDIDATE_ENTRIES + i)];
            if (entry_distance(entry) <= candidates.cover)
                candidate_triangles[candidate_word(VOILE_CANDIDATE_ENTRIES + kept++)] = entry;
        }
        candidates.count = kept;
    }
}

// m, from the middle of the ball; of a triangle that deforms at least, throughout the step: it is never farther from where it
// is halfway than half of the longest way of its corners.
float triangle_distance(uint triangle)
{
    if (COLLIDERS_MOVE == 0 || candidates.kind == 0)
    {
        const BvhTriangle t = bvh_triangles[triangle];
        return distance(candidates.middle, nearest_on_triangle(candidates.middle, t.a, t.b, t.c));
    }
    const MovingTriangle t = moving_triangle(triangle, candidates.first_corner, vec2(0, 1));
    const float way = max(max(distance(t.start.a, t.end.a), distance(t.start.b, t.end.b)), distance(t.start.c, t.end.c));
    const vec3 nearest = nearest_on_triangle(candidates.middle, 0.5 * (t.start.a + t.end.a), 0.5 * (t.start.b + t.end.b),
                                             0.5 * (t.start.c + t.end.c));
    return max(distance(candidates.middle, nearest) - 0.5 * way, 0);
}

void collect_triangle(uint triangle)
{
    if (candidates.count > VOILE_CANDIDATES)
        return;
    const float distance = triangle_distance(triangle);
    if (distance <= candidates.cover)
        narrow();
    if (distance > candidates.cover)
        return;
    if (candidates.count < VOILE_CANDIDATES)
    {
        candidate_triangles[candidate_word(VOILE_CANDIDATE_ENTRIES + candidates.count)] =
            candidates.kind | level_of(distance) << VOILE_CANDIDATE_TRIANGLE_BITS | triangle;
    }
    ++candidates.count;
}

void take_leaf(uint first, uint count)
{
    for (uint t = first; t < first + count; ++t)
    {
        if (candidates.collect)
            collect_triangle(t);
        else
            visit_triangle(t);
    }
}

// What a traversal reaches of a tree. To collect: what is in the ball, as narrow as it is by then, and nothing once it is known
// that the list is too short. Else what may be nearer than the nearest so far, or lies where the vertex goes through; boxes of
// what deforms hold all of its way, so the vertex's own way tells that, too.
bool query_reaches(vec3 box_min, vec3 box_max, vec3 node_min, vec3 node_max)
{
    if (candidates.collect)
        return candidates.count <= VOILE_CANDIDATES &&
               distance(candidates.middle, clamp(candidates.middle, node_min, node_max)) <= candidates.cover;
    const float nearest = query.distance + 10 * query_tie() + rounding(query.to);
    return boxes_overlap(box_min, box_max, node_min, node_max) &&
           (distance(query.to, clamp(query.to, node_min, node_max)) <= nearest ||
            boxes_overlap(min(query.from, query.to), max(query.from, query.to), node_min, node_max));
}

#define VOILE_REACHED query_reaches
#include "colliders/bvh.glsl"
#include "colliders/padded.glsl"

void traverse(ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    if (is_deforming(collider.flags))
        visit_padded(collider.first_node, collider.first_triangle, collider.triangles, box_min, box_max);
    else
        visit_box(collider.first_node, collider.first_triangle, box_min, box_max);
}

// The middle of what the list covers in the space of collider c.
vec3 covered_middle(uint c, uint flags)
{
    return into_collider(c, flags, FinePosition(candidates.place, vec3(0)), candidates.made);
}

// m, the radius of a ball like the list's that has all that lies on the way from `from` to `to` or within `reach` of its end;
// these are in the space of collider c.
float needed_cover(uint c, uint flags, vec3 from, vec3 to, float reach)
{
    if (candidates.made < 0 && (is_moved(flags) || is_deforming(flags)))
        return 3e38;
    const vec3 middle = covered_middle(c, flags);
    return max(distance(middle, from), distance(middle, to) + reach);
}

bool belongs(uint entry, ColliderRecord collider, uint kind)
{
    const uint triangle = entry & VOILE_CANDIDATE_TRIANGLE_MASK;
    return (entry & VOILE_CANDIDATE_SLOT) == kind && triangle >= collider.first_triangle &&
           triangle < collider.first_triangle + collider.triangles;
}

void visit_mesh(uint c, ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    const uint kind = is_deforming(collider.flags) ? VOILE_CANDIDATE_SLOT : 0;
    const float needed = needed_cover(c, collider.flags, query.from, query.to, query.thickness);
    if (candidates.count > VOILE_CANDIDATES || needed > candidates.cover)
    {
        traverse(collider, box_min, box_max);
        return;
    }
    load_radii();
    uint next = candidate_triangles[candidate_word(VOILE_CANDIDATE_ENTRIES)]; // one ahead: it comes while one is tested
    for (uint i = 0; i < candidates.count; ++i)
    {
        const uint entry = next;
        next = candidate_triangles[candidate_word(VOILE_CANDIDATE_ENTRIES + min(i + 1, VOILE_CANDIDATES - 1))];
        if (entry_distance(entry) <= needed && belongs(entry, collider, kind))
            visit_triangle(entry & VOILE_CANDIDATE_TRIANGLE_MASK);
    }
}

// Whether every mesh that moves is either covered or out of reach. `way`: m, the farthest that one carries its surface here.
bool serves_moving(FinePosition from, vec3 displacement, float reach, inout float way)
{
    if (COLLIDERS_MOVE == 0)
        return true;
    bool serves = true;
    const vec3 to = from.x + displacement;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, min(from.x, to), max(from.x, to));
    uint c;
    while (next_collider(walk, c))
    {
        const uint flags = colliders[c].flags;
        if (!(is_moved(flags) || is_deforming(flags)) || colliders[c].kind != VOILE_COLLIDER_MESH)
            continue;
        vec3 a = from_origin(c, flags, from);
        vec3 b = a + displacement;
        float gone = 0;
        if (is_moved(flags))
        {
            const vec3 end = b;
            const Pose start = pose_at(c, push.progress_from);
            a = to_collider(start, a);
            b = to_collider(pose_at(c, push.progress_to), end);
            gone = distance(to_world(start, b), end);
        }
        const vec3 box_min = min(a, b) - reach;
        const vec3 box_max = max(a, b) + reach;
        if (!reaches(colliders[c], box_min, box_max))
            continue;
        way = max(way, gone);
        serves = serves && needed_cover(c, flags, a, b, reach) <= candidates.cover;
    }
    return serves;
}

void collect_triangles()
{
    candidates.count = 0;
    candidates.collect = true;
    ColliderWalk walk =
        walk_colliders(gl_WorkGroupID.x, candidates.place - candidates.cover, candidates.place + candidates.cover);
    uint c;
    while (next_collider(walk, c))
    {
        const ColliderRecord collider = colliders[c];
        if (collider.kind != VOILE_COLLIDER_MESH)
            continue;
        candidates.middle = covered_middle(c, collider.flags);
        candidates.kind = 0;
        if (is_deforming(collider.flags))
        {
            candidates.kind = VOILE_CANDIDATE_SLOT;
            candidates.first_corner = uvec2(collider_motions[c].first_from, collider_motions[c].first_to);
        }
        const vec3 box_min = candidates.middle - candidates.cover;
        const vec3 box_max = candidates.middle + candidates.cover;
        if (reaches(collider, box_min, box_max))
            traverse(collider, box_min, box_max);
    }
    candidates.collect = false;
}

// Makes a new list. `own_way`: m, what the ball must have of the substep's own way; `margin`: m, what it is to have beyond it;
// `reach`: m, how far from the vertex contact looks.
void renew_candidates(float own_way, float margin, float reach)
{
    // Where the last ball was narrowed, this one is to be little wider: what is found beyond would be lost again.
    const float last = candidates.cover - reach;
    const bool narrowed = last >= 0 && candidates.cover < candidates.wished;
    const float grown = max(VOILE_CANDIDATE_GROWTH * last, 0.1 * VOILE_CANDIDATE_MARGIN * reach);
    candidates.least = reach + own_way;
    candidates.wished = candidates.least + (narrowed ? min(margin, grown) : margin);
    candidates.cover = candidates.wished;
    collect_triangles();
    if (candidates.count > VOILE_CANDIDATES)
        candidates.cover = candidates.wished; // until the next renewal: it would find as many
    candidate_places[candidates.vertex] = vec4(candidates.place, candidates.cover);
    candidate_triangles[candidate_word(VOILE_CANDIDATE_HEAD)] =
        push.substep << VOILE_CANDIDATE_COUNT_BITS | candidates.count;
    candidate_triangles[candidate_word(VOILE_CANDIDATE_RADIUS)] = floatBitsToUint(candidates.wished);
    candidate_triangles[candidate_word(VOILE_CANDIDATE_LEAST)] = floatBitsToUint(candidates.least);
}

// m, how far the path from `from` leads from a place of the world.
float way_from(vec3 place, FinePosition from, vec3 displacement)
{
    const vec3 offset = from.x - place + from.residual;
    return max(length(offset), length(offset + displacement));
}

// Takes the vertex's list, or makes a new one where it does not cover the displacement, m, from `from`.
void find_candidates(uint vertex, FinePosition from, vec3 displacement, vec3 velocity, float thickness)
{
    candidates.vertex = vertex;
    candidates.collect = false;
    const vec4 place = candidate_places[vertex]; // w: m, the radius of the ball; < 0: there is no list
    const uint head = candidate_triangles[candidate_word(VOILE_CANDIDATE_HEAD)];
    const float reach = VOILE_CANDIDATE_REACH * thickness + rounding(vec3(push.mesh_extent));
    const uint made = head >> VOILE_CANDIDATE_COUNT_BITS;
    candidates.count = head & VOILE_CANDIDATE_COUNT_MASK;
    candidates.place = place.xyz;
    candidates.cover = place.w;
    candidates.made = made < push.first_substep
                          ? -1
                          : min(float(made - push.first_substep + 1) * push.progress_a_substep, 1);
    const float margin = place.w - reach; // below 0 where the cloth has become thicker
    const float used = push.renew == 1 ? 0.5 * margin : margin;
    const bool serves = way_from(place.xyz, from, displacement) <= used;
    float way = 0;
    const bool serves_all = serves_moving(from, displacement, reach, way);
    const float speed = length(velocity) + way / push.step;
    const float wanted = max(VOILE_CANDIDATE_MARGIN * thickness, 2 * speed * push.renewal_time);
    // What had no room in a list when the vertex was fast, or too near, has some when it rests.
    const bool may_fit = push.renew == 1 && candidates.count > VOILE_CANDIDATES;
    if (serves && serves_all && !may_fit)
        return;
    candidates.place = from.x + 0.5 * displacement;
    candidates.made = push.progress_to;
    load_radii();
    renew_candidates(way_from(candidates.place, from, displacement) + way, wanted, reach);
}

#endif
