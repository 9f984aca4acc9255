// The leaves near a vertex, kept from substep to substep.
//
// A traversal finds all leaves within a box around the vertex that is wider by a margin than a substep needs. As long as
// the vertex stays within that margin, the following substeps test these leaves alone: the same triangles that a traversal
// of their own would find, in the same order, and a few more. Where a vertex has more leaves than the list holds, every
// substep traverses. Threads wait for the slowest among them: so that most substeps have no traversal at all, lists are
// renewed together, every VOILE_RENEWAL substeps, by all vertices that have used up half of their margin.
// The including kernel declares candidate_places[] and candidate_leaves[] and includes contact_query.glsl before.
#ifndef VOILE_CONTACT_CANDIDATES_GLSL
#define VOILE_CONTACT_CANDIDATES_GLSL


struct Candidates
{
    uint vertex;
    uint count;   // VOILE_CANDIDATES + 1: more than fit
    bool collect; // take_leaf puts them into the list; else it visits their triangles
    vec3 box_min; // what the list covers
    vec3 box_max;
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
            (count - 1) << VOILE_BVH_COUNT_SHIFT | first;
    candidates.count = min(candidates.count + 1, VOILE_CANDIDATES + 1);
}

#include "bvh.glsl"

void visit_mesh(ColliderRecord collider, vec3 box_min, vec3 box_max)
{
    const bool covered = all(lessThanEqual(candidates.box_min, box_min)) &&
                         all(lessThanEqual(box_max, candidates.box_max)) && candidates.count <= VOILE_CANDIDATES;
    if (!covered)
    {
        visit_box(collider.first_node, collider.first_triangle, box_min, box_max);
        return;
    }
    const uint list = candidates.vertex * (VOILE_CANDIDATES + 1) + 1;
    for (uint i = 0; i < candidates.count; ++i)
    {
        const uint leaf = candidate_leaves[list + i];
        const uint first = leaf & VOILE_BVH_FIRST_MASK;
        if (first >= collider.first_triangle && first < collider.first_triangle + collider.triangles)
            take_leaf(first, (leaf >> VOILE_BVH_COUNT_SHIFT) + 1);
    }
}

// Takes the vertex's list, or makes a new one where it does not cover the way from `from` to `to` and what contact may add.
void find_candidates(uint vertex, uint collider_count, vec3 from, vec3 to, float speed, float thickness)
{
    const vec4 place = candidate_places[vertex]; // w: half the side of the box that the way must stay in; < 0: none
    const float reach = 2 * thickness;           // the distance that contact keeps, from either side
    candidates.vertex = vertex;
    candidates.collect = false;
    const float used = push.renew == 1 ? 0.5 * place.w : place.w;
    const bool serves =
        all(lessThanEqual(abs(from - place.xyz), vec3(used))) && all(lessThanEqual(abs(to - place.xyz), vec3(used)));
    if (serves)
    {
        candidates.count = candidate_leaves[vertex * (VOILE_CANDIDATES + 1)];
        candidates.box_min = place.xyz - (place.w + reach);
        candidates.box_max = place.xyz + (place.w + reach);
        return;
    }
    const float margin = max(0.5 * thickness, 2 * speed * push.renewal_time) + 0.5 * distance(from, to);
    const vec3 middle = 0.5 * (from + to);
    candidates.count = 0;
    candidates.box_min = middle - (margin + reach);
    candidates.box_max = middle + (margin + reach);
    candidates.collect = true;
    for (uint c = 0; c < collider_count; ++c)
        if (colliders[c].kind == VOILE_COLLIDER_MESH &&
            boxes_overlap(candidates.box_min, candidates.box_max, colliders[c].box_min, colliders[c].box_max))
            visit_box(colliders[c].first_node, colliders[c].first_triangle, candidates.box_min, candidates.box_max);
    candidates.collect = false;
    candidate_places[vertex] = vec4(middle, margin);
    candidate_leaves[vertex * (VOILE_CANDIDATES + 1)] = candidates.count;
}

#endif
