// The leaves near a vertex, kept from substep to substep.
//
// A traversal finds all leaves within a box around the vertex that is wider by a margin than a substep needs. As long as
// the vertex stays within that margin, the following substeps test these leaves alone: the same triangles that a traversal
// of their own would find, in the same order, and a few more. Where a vertex has more leaves than the list holds, every
// substep traverses. Threads wait for the slowest among them: so that most substeps have no traversal at all, lists are
// renewed together, every VOILE_RENEWAL substeps, by all vertices that have used up half of their margin.
// A moving collider has the list of the place where the vertex was, in the collider's space, when the list was made; it holds
// within the step in which that was. So does the list of a deforming one, whose boxes cover all of the step.
// The including kernel declares candidate_places[] and candidate_leaves[] and includes contact_query.glsl and
// collider_pose.glsl before.
#ifndef VOILE_CONTACT_CANDIDATES_GLSL
#define VOILE_CONTACT_CANDIDATES_GLSL

// Set in a leaf of the list: it is a slot of a padded tree.
#define VOILE_CANDIDATE_DEFORMS VOILE_BVH_LEAF_BIT

struct Candidates
{
    uint vertex;
    uint count;   // VOILE_CANDIDATES + 1: more than fit
    bool collect; // take_leaf puts them into the list; else it visits their triangles
    vec3 place;   // m, world: the middle of what the list covers
    float cover;  // m, half the side of that box, with what contact reaches
    float made;   // progress of the step when the list was made; < 0: in a step before
    uint kind;    // VOILE_CANDIDATE_DEFORMS, or 0: of the mesh that is traversed
};
Candidates candidates;

void take_leaf(uint first, uint count)
{
    if (!candidates.collect)
    {
        for (uint t = first; t < first + count; ++t)
            visit_triangle(t);
        return;
    }
    if (candidates.count < VOILE_CANDIDATES)
        candidate_leaves[candidates.vertex * (VOILE_CANDIDATES + 1) + 1 + candidates.count] =
            candidates.kind | (count - 1) << VOILE_BVH_COUNT_SHIFT | first;
    candidates.count = min(candidates.count + 1, VOILE_CANDIDATES + 1);
}

#include "bvh.glsl"
#include "padded.glsl"

void traverse(ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    const bool deforms = is_deforming(collider.flags);
    candidates.kind = deforms ? VOILE_CANDIDATE_DEFORMS : 0;
    if (deforms)
        visit_padded(collider.first_node, collider.first_triangle, collider.triangles, box_min, box_max);
    else
        visit_box(collider.first_node, collider.first_triangle, box_min, box_max);
}

// The middle of what the list covers in the space of collider c.
vec3 covered_middle(uint c, uint flags)
{
    return is_moved(flags) ? to_collider(pose_at(c, candidates.made), candidates.place) : candidates.place;
}

bool covers(uint c, uint flags, vec3 box_min, vec3 box_max)
{
    if (candidates.made < 0 && (is_moved(flags) || is_deforming(flags)))
        return false;
    const vec3 middle = covered_middle(c, flags);
    return all(lessThanEqual(middle - candidates.cover, box_min)) &&
           all(lessThanEqual(box_max, middle + candidates.cover));
}

void visit_mesh(uint c, ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    if (candidates.count > VOILE_CANDIDATES || !covers(c, collider.flags, box_min, box_max))
    {
        traverse(collider, box_min, box_max);
        return;
    }
    const uint kind = is_deforming(collider.flags) ? VOILE_CANDIDATE_DEFORMS : 0;
    const uint list = candidates.vertex * (VOILE_CANDIDATES + 1) + 1;
    for (uint i = 0; i < candidates.count; ++i)
    {
        const uint leaf = candidate_leaves[list + i];
        const uint first = leaf & VOILE_BVH_FIRST_MASK;
        if ((leaf & VOILE_CANDIDATE_DEFORMS) == kind && first >= collider.first_triangle &&
            first < collider.first_triangle + collider.triangles)
            take_leaf(first, (leaf >> VOILE_BVH_COUNT_SHIFT & VOILE_BVH_COUNT_MASK) + 1);
    }
}

// Whether every mesh that moves is either covered or out of reach. `way`: m, the farthest that one carries its surface here.
bool serves_moving(vec3 from, vec3 to, float reach, inout float way)
{
    if (COLLIDERS_MOVE == 0)
        return true;
    bool serves = true;
    for (uint c = 0; c < push.colliders; ++c)
    {
        const uint flags = colliders[c].flags;
        if (!(is_moved(flags) || is_deforming(flags)) || colliders[c].kind != VOILE_COLLIDER_MESH)
            continue;
        vec3 a = from;
        vec3 b = to;
        float gone = 0;
        if (is_moved(flags))
        {
            const Pose start = pose_at(c, push.progress_from);
            a = to_collider(start, from);
            b = to_collider(pose_at(c, push.progress_to), to);
            gone = distance(to_world(start, b), to);
        }
        const vec3 box_min = min(a, b) - reach;
        const vec3 box_max = max(a, b) + reach;
        if (!reaches(colliders[c], box_min, box_max))
            continue;
        way = max(way, gone);
        serves = serves && covers(c, flags, box_min, box_max);
    }
    return serves;
}

void collect_leaves()
{
    candidates.count = 0;
    candidates.collect = true;
    for (uint c = 0; c < push.colliders; ++c)
    {
        if (colliders[c].kind != VOILE_COLLIDER_MESH)
            continue;
        const vec3 middle = covered_middle(c, colliders[c].flags);
        const vec3 box_min = middle - candidates.cover;
        const vec3 box_max = middle + candidates.cover;
        if (reaches(colliders[c], box_min, box_max))
            traverse(colliders[c], box_min, box_max);
    }
    candidates.collect = false;
}

// Takes the vertex's list, or makes a new one where it does not cover the way from `from` to `to` and what contact may add.
void find_candidates(uint vertex, vec3 from, vec3 to, vec3 velocity, float thickness)
{
    const vec4 place = candidate_places[vertex]; // w: half the side of the box that the way must stay in; < 0: none
    const float reach = 2 * thickness;           // the distance that contact keeps, from either side
    const uint head = candidate_leaves[vertex * (VOILE_CANDIDATES + 1)];
    const uint made = head >> VOILE_CANDIDATE_COUNT_BITS;
    candidates.vertex = vertex;
    candidates.collect = false;
    candidates.count = head & VOILE_CANDIDATE_COUNT_MASK;
    candidates.place = place.xyz;
    candidates.cover = place.w + reach;
    candidates.made = made < push.first_substep
                          ? -1
                          : min(float(made - push.first_substep + 1) * push.progress_a_substep, 1);
    const float used = push.renew == 1 ? 0.5 * place.w : place.w;
    const bool serves =
        all(lessThanEqual(abs(from - place.xyz), vec3(used))) && all(lessThanEqual(abs(to - place.xyz), vec3(used)));
    float way = 0;
    const bool serves_all = serves_moving(from, to, reach, way);
    if (serves && serves_all)
        return;
    const float speed = length(velocity) + way / push.step;
    const float margin = max(0.5 * thickness, 2 * speed * push.renewal_time) + 0.5 * distance(from, to) + way;
    candidates.place = 0.5 * (from + to);
    candidates.cover = margin + reach;
    candidates.made = push.progress_to;
    collect_leaves();
    candidate_places[vertex] = vec4(candidates.place, margin);
    candidate_leaves[vertex * (VOILE_CANDIDATES + 1)] = push.substep << VOILE_CANDIDATE_COUNT_BITS | candidates.count;
}

#endif
