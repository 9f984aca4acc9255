// Lists of the triangles near each vertex, kept from substep to substep.
//
// A traversal collects all triangles within a ball around the vertex. The ball is wider than one substep needs by a
// margin. While the vertex stays within the margin relative to each mesh near it, the next substeps test only these
// triangles, and skip those whose stored distance is too large. A dispatch waits for its slowest thread: for one long list, or for one traversal.
// Therefore:
//   - all lists are refreshed together, every few passes, if half of their margin is used up;
//   - the ball shrinks while triangles are found, so that the list stays short;
//   - a vertex with more triangles than fit without any margin traverses in every substep, and refreshes try again.
// The list of a moving collider is relative to the collider's position when the list was made. It is valid
// until the end of that step. The list of a deforming mesh has the triangles that may come near until lists are refreshed
// next, and is valid until then.
// The including kernel declares candidate_centers[], candidate_triangles[], patch_of_group() and what mesh_query.glsl
// expects, and includes near_colliders.glsl before.
#ifndef VOILE_CONTACT_CANDIDATES_GLSL
#define VOILE_CONTACT_CANDIDATES_GLSL

#include "contact/contact_vertex.glsl"
#include "contact/mesh_query.glsl"

// The margin of a vertex at rest, as a fraction of the thickness.
const float k_candidate_margin = 0.5;
// Of a vertex near a mesh that deforms, over the way that it goes until lists are refreshed.
const float k_deforming_ahead = 1.25;
// The query radius of contact over the thickness. Vertices that may touch a surface before the next pass get its plane.
const float k_plane_radius = 1.02;
// That of a list over the query radius: room for the rounding of distances.
const float k_list_radius = 1.001;
// The ball shrinks while the list is at least this long. The next list's margin may be larger by the growth factor.
const uint k_aimed_count = 11;
const float k_margin_growth = 1.5;
// A margin below this fraction of the ball's radius is not shrunk to shorten the list.
const float k_lasting_margin = 0.03;

// Words of the list: the head with its length; the largest and the least radius of the ball; then the entries. An entry
// is a triangle, or a slot of an implicit BVH, with its distance from the ball's center as a level between both radii.
// Levels are finest near the least radius: where many triangles are near, they decide which of them the ball must
// contain.
const uint k_head_word = 0;
const uint k_max_radius_word = 1;
const uint k_min_radius_word = 2;
const uint k_first_entry = 3;
const uint k_slot_bit = 0x80000000u; // the entry is a slot
const uint k_levels = 31;
const uint k_triangle_mask = (1u << VOILE_CANDIDATE_TRIANGLE_BITS) - 1;

// The list of a vertex.
struct Candidates
{
    uint vertex;
    uint count;   // VOILE_CANDIDATES + 1: more than fit
    vec3 center;  // m, world: the query center, middle of the ball that the list covers
    float radius; // m, of the ball
    float max_radius; // m, the largest radius
    float min_radius;  // m, the least radius
    float made;   // progress of the step when the list was made; < 0: in an earlier step
    bool recent;  // made since lists were refreshed last
    bool fresh;   // made in this pass
    bool needed;  // by a mesh near the vertex, in this pass
    // Of the mesh that is being traversed to collect.
    vec3 local_center;  // m, the query center in the mesh's space
    uint kind;          // k_slot_bit if it deforms, else 0
    uvec2 first_corner; // as in MeshQuery
};

// Word-major order: neighboring threads read the same word at the same time.
uint candidate_word(Candidates list, uint word) { return word * push.vertices + list.vertex; }

// Loaded only where the list is read or made. For most vertices it is neither.
void load_radii(inout Candidates list)
{
    list.max_radius = uintBitsToFloat(candidate_triangles[candidate_word(list, k_max_radius_word)]);
    list.min_radius = uintBitsToFloat(candidate_triangles[candidate_word(list, k_min_radius_word)]);
}

// m: a lower bound of an entry's distance from the query center.
float entry_distance(Candidates list, uint entry)
{
    const float level = float(entry >> VOILE_CANDIDATE_TRIANGLE_BITS & k_levels) / k_levels;
    return level > 0 ? list.min_radius + level * level * (list.max_radius - list.min_radius) : 0;
}

uint level_of(Candidates list, float distance)
{
    const float at_least = 0.9999 * distance - rounding(list.local_center);
    const float fraction = (at_least - list.min_radius) / (list.max_radius - list.min_radius);
    return uint(sqrt(clamp(fraction, 0, 1)) * k_levels);
}

// Shrinks the ball until the list is short, while a lasting margin is left. A full list shrinks further, until it has
// room or the levels of its entries differ no more.
void shrink_ball(inout Candidates list)
{
    const float least_spare = (list.max_radius - list.min_radius) / (k_levels * k_levels);
    while (list.count >= k_aimed_count)
    {
        const float spare = list.radius - list.min_radius;
        const bool has_room = list.count < VOILE_CANDIDATES;
        if (spare < (has_room ? k_lasting_margin * list.max_radius : least_spare))
            return;
        const float radius = list.min_radius + 0.5 * spare;
        if (radius >= list.radius)
            return; // by rounding
        list.radius = radius;
        uint kept = 0;
        for (uint i = 0; i < list.count; ++i)
        {
            const uint entry = candidate_triangles[candidate_word(list, k_first_entry + i)];
            if (entry_distance(list, entry) <= list.radius)
                candidate_triangles[candidate_word(list, k_first_entry + kept++)] = entry;
        }
        list.count = kept;
    }
}

// m, from the query center. For a triangle that deforms a lower bound until lists are refreshed: the triangle is never
// farther from its halfway position than half of its corners' longest displacement.
float triangle_distance(Candidates list, uint triangle)
{
    if (COLLIDERS_MOVE == 0 || list.kind == 0)
    {
        const BvhTriangle t = bvh_triangles[triangle];
        return distance(list.local_center, nearest_on_triangle(list.local_center, t.a, t.b, t.c));
    }
    const MovingTriangle t = moving_triangle(triangle, list.first_corner, vec2(push.progress_from, push.progress_next));
    const float longest = max(max(distance(t.start.a, t.end.a), distance(t.start.b, t.end.b)), distance(t.start.c, t.end.c));
    const vec3 nearest = nearest_on_triangle(list.local_center, 0.5 * (t.start.a + t.end.a), 0.5 * (t.start.b + t.end.b),
                                             0.5 * (t.start.c + t.end.c));
    return max(distance(list.local_center, nearest) - 0.5 * longest, 0);
}

void collect_triangle(inout Candidates list, uint triangle)
{
    if (list.count > VOILE_CANDIDATES)
        return;
    const float distance = triangle_distance(list, triangle);
    if (distance <= list.radius)
        shrink_ball(list);
    if (distance > list.radius)
        return;
    if (list.count < VOILE_CANDIDATES)
    {
        candidate_triangles[candidate_word(list, k_first_entry + list.count)] =
            list.kind | level_of(list, distance) << VOILE_CANDIDATE_TRIANGLE_BITS | triangle;
    }
    ++list.count;
}

// Whether a traversal enters a node's box: if it touches the ball, which shrinks meanwhile; never once the list has
// overflowed.
bool enters_node(Candidates list, Box node)
{
    return list.count <= VOILE_CANDIDATES &&
           distance(list.local_center, clamp(list.local_center, node.min, node.max)) <= list.radius;
}

void visit_leaf(inout Candidates list, uint first, uint count)
{
    for (uint t = first; t < first + count; ++t)
        collect_triangle(list, t);
}

#define VOILE_QUERY Candidates
#include "colliders/mesh_traversal.glsl"
#undef VOILE_QUERY

// The query center in the space of collider c.
vec3 local_query_center(Candidates list, uint c, uint flags)
{
    return into_collider(c, flags, FinePosition(list.center, vec3(0)), list.made);
}

// m: the radius of the smallest ball around the query center that contains the path and a ball of its query radius around
// its end. The path is in the space of collider c.
float needed_radius(Candidates list, uint c, uint flags, Path path)
{
    if ((is_moved(flags) && list.made < 0) || (is_deforming(flags) && !list.recent))
        return 3e38;
    const vec3 center = local_query_center(list, c, flags);
    return max(distance(center, path.from), distance(center, path.to) + path.radius);
}

bool belongs(uint entry, ColliderRecord collider, uint kind)
{
    const uint triangle = entry & k_triangle_mask;
    return (entry & k_slot_bit) == kind && triangle >= collider.first_triangle &&
           triangle < collider.first_triangle + collider.triangles;
}

void collect_triangles(inout Candidates list, uint layers)
{
    list.count = 0;
    ColliderWalk walk = walk_colliders(patch_of_group(), grown(Box(list.center, list.center), list.radius));
    uint c;
    while (next_collider(walk, c))
    {
        const ColliderRecord collider = colliders[c];
        if (collider.kind != VOILE_COLLIDER_MESH)
            continue;
        list.local_center = local_query_center(list, c, collider.flags);
        list.kind = 0;
        if (is_deforming(collider.flags))
        {
            list.kind = k_slot_bit;
            list.first_corner = uvec2(collider_motions[c].first_from, collider_motions[c].first_to);
        }
        if (overlaps_mesh(collider, layers, grown(Box(list.local_center, list.local_center), list.radius)))
            traverse(list, collider);
    }
}

// Makes a new list. `path`: m, the longest distance of this substep's path from the query center; `margin`: m, beyond
// that; `query_radius`: m, of contact around the vertex.
void refresh_candidates(inout Candidates list, uint layers, float path, float margin, float query_radius)
{
    // If the last ball shrank, this one is only a little wider: what lies farther out would be dropped again.
    const float last = list.radius - query_radius;
    const bool shrank = last >= 0 && list.radius < list.max_radius;
    const float grown = max(k_margin_growth * last, 0.1 * k_candidate_margin * query_radius);
    list.min_radius = query_radius + path;
    list.max_radius = list.min_radius + (shrank ? min(margin, grown) : margin);
    list.radius = list.max_radius;
    collect_triangles(list, layers);
    if (list.count > VOILE_CANDIDATES)
        list.radius = list.max_radius; // until the next refresh, which would find as many
    candidate_centers[list.vertex] = vec4(list.center, list.radius);
    candidate_triangles[candidate_word(list, k_head_word)] =
        counted_substep(push.substep) << VOILE_CANDIDATE_COUNT_BITS | list.count;
    candidate_triangles[candidate_word(list, k_max_radius_word)] = floatBitsToUint(list.max_radius);
    candidate_triangles[candidate_word(list, k_min_radius_word)] = floatBitsToUint(list.min_radius);
}

Candidates load_candidates(uint vertex)
{
    Candidates list;
    list.vertex = vertex;
    const vec4 ball = candidate_centers[vertex]; // w: m, the radius; < 0: there is no list
    const uint head = candidate_triangles[candidate_word(list, k_head_word)];
    const uint made = head >> VOILE_CANDIDATE_COUNT_BITS;
    list.count = head & VOILE_CANDIDATE_COUNT_MASK;
    list.center = ball.xyz;
    list.radius = ball.w;
    list.made = made < step_input.first_substep ? -1
                                          : min(float(made - step_input.first_substep + 1) * push.progress_per_substep, 1);
    list.recent = made >= counted_substep(push.listed);
    list.fresh = false;
    list.needed = false;
    return list;
}

// m
float query_radius(float thickness)
{
    return (push.result == VOILE_CONTACT_KEEPS_START ? k_plane_radius : 1) * thickness;
}

// m: the least radius of a list around a vertex that does not move.
float listed_radius(float thickness) { return k_list_radius * query_radius(thickness) + rounding(vec3(push.mesh_extent)); }

// m: how far the vertex may get relative to a mesh until lists are refreshed again. With as much to spare, so that the next
// refresh may leave it out; none leaves out what is near a mesh that deforms.
float distance_ahead(float path, bool deforms)
{
    return (deforms ? k_deforming_ahead : 2) * path * push.refresh_substeps / push.substeps;
}

// The meshes near a vertex within this pass.
struct NearMeshes
{
    float carried; // m, the longest displacement that one gives its surface at the vertex
    float ahead;   // m, how far the vertex may get relative to one
};

NearMeshes near_meshes(Motion motion, ClothContact cloth)
{
    if (COLLIDERS_MOVE == 0)
        return NearMeshes(0, distance_ahead(length(motion.displacement), false));
    NearMeshes result = NearMeshes(0, 0);
    ColliderWalk walk = walk_colliders(patch_of_group(), box_around(motion.from.x, position_of(motion)));
    uint c;
    while (next_collider(walk, c))
    {
        const uint flags = colliders[c].flags;
        if (colliders[c].kind != VOILE_COLLIDER_MESH)
            continue;
        vec3 from = from_origin(c, flags, motion.from);
        vec3 to = from + motion.displacement;
        float carried = 0;
        if (is_moved(flags))
        {
            const vec3 end = to;
            const Pose start = pose_at(c, push.progress_from);
            from = to_collider(start, from);
            to = to_collider(pose_at(c, push.progress_to), end);
            carried = distance(to_world(start, to), end);
        }
        const float path = distance(from, to);
        const float ahead = distance_ahead(path, is_deforming(flags));
        if (!overlaps_mesh(colliders[c], cloth.layers,
                           grown(box_around(from, to), listed_radius(cloth.thickness) + ahead)))
            continue;
        result.carried = max(result.carried, carried);
        result.ahead = max(result.ahead, ahead);
    }
    return result;
}

// m: the longest distance of the vertex's path from the query center.
float path_distance(vec3 center, Motion motion)
{
    const vec3 offset = motion.from.x - center + motion.from.residual;
    return max(length(offset), length(offset + motion.displacement));
}

// A new list around the middle of the vertex's path.
void refresh_list(inout Candidates list, Motion motion, ClothContact cloth)
{
    list.fresh = list.recent = true;
    list.center = motion.from.x + 0.5 * motion.displacement;
    list.made = push.progress_to;
    load_radii(list);
    const NearMeshes meshes = near_meshes(motion, cloth);
    const float path = path_distance(list.center, motion) + meshes.carried;
    refresh_candidates(list, cloth.layers, path, max(k_candidate_margin * cloth.thickness, meshes.ahead),
                       listed_radius(cloth.thickness));
}

// Whether the list need not be made anew. When all are refreshed, it lasts if half of its margin is left. One that
// overflowed when the vertex was fast, or too close, may fit then.
bool lasts(Candidates list, float needed, float thickness)
{
    const float margin = max(list.radius - listed_radius(thickness), 0);
    return list.fresh || (push.refresh == 0 ? needed <= list.radius
                                            : needed + 0.5 * margin <= list.radius && list.count <= VOILE_CANDIDATES);
}

void visit_mesh(inout MeshQuery query, inout Candidates list, uint c, ColliderRecord collider, Motion motion, ClothContact cloth)
{
    list.needed = true;
    float needed = needed_radius(list, c, collider.flags, query.path);
    if (COLLIDERS_MOVE != 0 && !lasts(list, needed, cloth.thickness))
    {
        refresh_list(list, motion, cloth);
        needed = needed_radius(list, c, collider.flags, query.path);
    }
    if (list.count > VOILE_CANDIDATES || needed > list.radius)
    {
        traverse(query, collider);
        return;
    }
    load_radii(list);
    const uint kind = is_deforming(collider.flags) ? k_slot_bit : 0;
    uint next = candidate_triangles[candidate_word(list, k_first_entry)]; // loaded one ahead, while the current one is tested
    for (uint i = 0; i < list.count; ++i)
    {
        const uint entry = next;
        next = candidate_triangles[candidate_word(list, k_first_entry + min(i + 1, VOILE_CANDIDATES - 1))];
        if (entry_distance(list, entry) <= needed && belongs(entry, collider, kind))
            visit_triangle(query, entry & k_triangle_mask);
    }
}

// The list of a vertex. If no collider moves, motion in the world is what ends it, and the list is made before meshes are
// visited: on CPU devices code in the loop over colliders is paid for whether a thread takes it or not.
Candidates list_of(uint vertex, Motion motion, ClothContact cloth)
{
    Candidates list = load_candidates(vertex);
    if (COLLIDERS_MOVE != 0)
        return list;
    const float needed = path_distance(list.center, motion) + listed_radius(cloth.thickness);
    if (!lasts(list, needed, cloth.thickness))
        refresh_list(list, motion, cloth);
    return list;
}

// When all lists are refreshed, those that no mesh needs end.
void end_list(Candidates list)
{
    if (COLLIDERS_MOVE == 0 || push.refresh == 0 || list.needed || list.radius < 0)
        return;
    candidate_centers[list.vertex] = vec4(list.center, -1);
    candidate_triangles[candidate_word(list, k_head_word)] = 0;
}

#endif
