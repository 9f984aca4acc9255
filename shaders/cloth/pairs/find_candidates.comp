#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Finds the vertices whose primitives may be near those of a vertex: its candidates. push.candidate_lanes threads per
// vertex traverse the hierarchy alike. Each takes some of the vertices of a leaf, so that each of them has a list of its
// own, whatever the number of threads. The vertices that have many candidates are listed, in no order, for find_pairs.comp,
// and the candidates of the others for sift_candidates.comp.
//
// Most vertices that are near each other are neighbors in cloth that is almost flat (flat.glsl). They are no candidates.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(pair_order)) readonly buffer PairOrder { uvec2 pair_order[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_wedges)) readonly buffer MeshWedges { MeshWedge mesh_wedges[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_islands)) readonly buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_boxes)) readonly buffer PairBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(pair_flats)) readonly buffer PairFlats { vec2 pair_flats[]; };
layout(VOILE_BINDING(pair_references)) writeonly buffer PairReferences { uint candidates[]; };
layout(VOILE_BINDING(pair_entries)) writeonly buffer PairEntries { uint candidate_places[]; };
layout(VOILE_BINDING(pair_masks)) writeonly buffer PairMasks { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_lists)) writeonly buffer PairLists { PairList pair_lists[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "contact/rounding.glsl"
#include "shared/box.glsl"
#include "pairs/candidate_lists.glsl"
#include "pairs/flat.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/reservation.glsl"
#include "pairs/tree_carry.glsl"
#include "pairs/wedges.glsl"

// The search of a vertex.
struct Search
{
    Fan fan;
    uint cloth;
    uint island;
    Flat flat_around;
    float least_flat; // m, a neighborhood is flat if it keeps primitives so far apart
    Viewpoint from;   // the middle of the vertex's sweep, carried as the vertex is
    Box hull;         // of the fan with its sweeps, from there
    Box tree_hull;    // the same, carried as the boxes of the hierarchy are
    Box box;          // the same in the world, with the range and rounding
    vec3 normal;      // of the fan, about: any unit vector will do
    vec2 heights;     // m, the lowest and the highest of the fan along it, from the viewpoint
    float range;
    float rounding; // m, of positions near it
    uint lane;
    uint lengths;   // of the lists of candidates, VOILE_PAIR_LENGTH_BITS each
    bool overflows; // one of them is full, and there are more
};

#define VOILE_QUERY Search

// A vertex with more candidates searches again, in a smaller range, so often.
const uint k_retries = 4;
const float k_retry_range = 0.6; // of the range before
const float k_unbounded = 1e30;

bool enters_node(Search search, Box node) { return overlap(search.box, node); }

// Columns and rows from the vertex that searches to another one of its grid.
ivec2 offset_to(Fan fan, uint vertex)
{
    const int from_row = fan.column_row.x + int(vertex) - int(fan.center); // from the first vertex of its row
    const int rows = int(floor((float(from_row) + 0.5) / float(fan.columns)));
    return ivec2(from_row - rows * int(fan.columns) - fan.column_row.x, rows);
}

// Whether another vertex of the grid is a neighbor in flat cloth. Then the range shrinks to how far that keeps
// primitives apart, at least. Both vertices find the same: either of them may have the neighborhood.
bool is_flat_neighbor(inout Search search, uint vertex)
{
    if (abs(int(vertex) - int(search.fan.center)) > (k_flat_offset.y + 1) * int(search.fan.columns))
        return false;
    const ivec2 at = offset_to(search.fan, vertex);
    if (!within(k_flat_offset, at))
        return false;
    float least = flat_distance(search.flat_around, at);
    if (least < search.least_flat)
    {
        const vec2 other = pair_flats[vertex];
        least = flat_distance(Flat(other.x, other.y), at);
    }
    if (least < search.least_flat)
        return false;
    search.range = min(search.range, least);
    return true;
}

// Around a fan with its sweeps.
struct Hull
{
    Box box;
    vec2 heights; // m, the lowest and the highest along the normal of the search
};

void add_node(inout Hull hull, vec3 normal, Node node)
{
    hull.box = joined(hull.box, Box(node.x - extent_of(node), node.x + extent_of(node)));
    const float height = dot(normal, node.x);
    const float sweep = abs(dot(normal, node.sweep)) + abs(dot(normal, node.carry)) + node.fall;
    hull.heights = vec2(min(hull.heights.x, height - sweep), max(hull.heights.y, height + sweep));
}

Hull hull_of(Fan fan, Viewpoint from, vec3 normal)
{
    Hull hull = Hull(Box(vec3(k_unbounded), vec3(-k_unbounded)), vec2(k_unbounded, -k_unbounded));
    add_node(hull, normal, node_of(fan.center, from));
    for (uint k = 0; k < fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(fan, k);
        if (wedge.triangle || wedge.edge_b)
            add_node(hull, normal, node_of(wedge.b, from));
        if (wedge.triangle || wedge.edge_c)
            add_node(hull, normal, node_of(wedge.c, from));
    }
    return hull;
}

// Layers of cloth are often near each other. Their boxes overlap unless they are across an axis, so the normal counts,
// too.
bool are_near(Search search, Hull hull)
{
    const float margin = search.range + search.rounding;
    return overlap(grown(hull.box, margin), search.hull) && hull.heights.x <= search.heights.y + margin &&
           hull.heights.y >= search.heights.x - margin;
}

// `list`: of candidates.
void consider(inout Search search, uint vertex, uint cloth, uint list)
{
    if (vertex == search.fan.center || !meets(search.cloth, cloth) || island_of(cloth) != search.island)
        return;
    if (cloth == search.cloth && search.fan.columns > 0 && is_flat_neighbor(search, vertex))
        return;
    if (!are_near(search, hull_of(fan_of(cloth, vertex), search.from, search.normal)))
        return;
    const uint length = length_of(search.lengths, list);
    if (length == VOILE_PAIR_CANDIDATE_LIST)
    {
        search.overflows = true;
        return;
    }
    candidates[candidate_place(search.fan.center, list, length)] = vertex;
    search.lengths += 1u << list * VOILE_PAIR_LENGTH_BITS;
}

void visit_leaf(inout Search search, uint leaf, uint count)
{
    const uint first = padded_boxes[leaf].padding_0 * VOILE_PAIR_LEAF;
    const uint end = min(first + VOILE_PAIR_LEAF, push.places);
    for (uint place = first + search.lane; place < end; place += push.candidate_lanes)
        consider(search, pair_order[place].x, pair_order[place].y, place - first);
}

#include "colliders/padded.glsl"

// Of the fan, as long as twice its area.
vec3 normal_of(Search search)
{
    vec3 normal = vec3(0);
    const vec3 center = midpoints[search.fan.center].xyz;
    for (uint k = 0; k < search.fan.wedges; ++k)
    {
        const Wedge wedge = wedge_of(search.fan, k);
        if (wedge.triangle)
            normal += cross(midpoints[wedge.b].xyz - center, midpoints[wedge.c].xyz - center);
    }
    return normal;
}

Search search_of(uint vertex, uint cloth, uint lane)
{
    Search search;
    search.fan = fan_of(cloth, vertex);
    search.cloth = cloth;
    search.island = island_of(cloth);
    const vec2 flats = pair_flats[vertex];
    search.flat_around = Flat(flats.x, flats.y);
    search.range = cloths[cloth].pair_range;
    search.least_flat = VOILE_FLAT_RANGE * search.range;
    search.from = viewpoint_of(vertex);
    search.rounding = 4 * rounding(search.from.x);
    const vec3 normal = normal_of(search);
    search.normal = normal / max(length(normal), 1e-30);
    const Hull hull = hull_of(search.fan, search.from, search.normal);
    search.hull = hull.box;
    search.tree_hull = hull_of(search.fan, tree_viewpoint(search.from.x, cloth), search.normal).box;
    search.heights = hull.heights;
    search.lane = lane;
    return search;
}

// Of each thread: what it has found, and whether it must search again.
shared uint shared_lengths[gl_WorkGroupSize.x];
shared float shared_ranges[gl_WorkGroupSize.x];
shared uint shared_overflows[gl_WorkGroupSize.x];
shared uint searching_again;

// What all threads of a vertex have found, in each of them. All threads of the workgroup call it.
void merge(inout Search search, uint thread, bool searches)
{
    shared_lengths[thread] = search.lengths;
    shared_ranges[thread] = search.range;
    shared_overflows[thread] = search.overflows ? 1 : 0;
    if (thread == 0)
        searching_again = 0;
    barrier();
    const uint first = thread - search.lane;
    for (uint k = first; k < first + push.candidate_lanes; ++k)
    {
        search.lengths |= shared_lengths[k];
        search.range = min(search.range, shared_ranges[k]);
        search.overflows = search.overflows || shared_overflows[k] != 0;
    }
    if (searches && search.overflows)
        searching_again = 1;
    barrier();
}

// A vertex with too many candidates searches again in a smaller range, at last with as many as fit and no range at all.
// All threads of the workgroup call it.
void find(inout Search search, uint thread, bool searches)
{
    for (uint k = 0; k <= k_retries; ++k)
    {
        if (searches && (k == 0 || search.overflows))
        {
            search.lengths = 0;
            search.overflows = false;
            search.box = grown(shifted(search.tree_hull, search.from.x), search.range + search.rounding);
            traverse_padded(search, 0, (1u << findMSB(2 * push.leaves - 1)) - 1, push.leaves);
        }
        merge(search, thread, searches);
        if (searching_again == 0)
            return;
        if (search.overflows)
            search.range *= k < k_retries ? k_retry_range : 0;
        barrier();
    }
}

// The next places in the lists of vertices that search and of candidates to sift, first of the workgroup, then of all.
shared uint shared_vertices;
shared uint shared_candidates;

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint lanes = push.candidate_lanes;
    const uint at = gl_GlobalInvocationID.x / lanes;
    if (thread == 0)
        shared_vertices = shared_candidates = 0;
    const bool searches = at < push.places && collides_with_itself(pair_order[at].y);
    const uint vertex = searches ? pair_order[at].x : 0;
    Search search;
    search.lane = thread % lanes;
    search.lengths = 0;
    search.range = k_unbounded;
    search.overflows = false;
    if (searches)
        search = search_of(vertex, pair_order[at].y, search.lane);
    find(search, thread, searches);
    if (searches && search.lane == 0)
        pair_lists[vertex] = PairList(search.range, 0, search.cloth, search.lengths);
    // What has many candidates is almost surely near one of them.
    const bool many = sum_of_lengths(search.lengths, 0, 1) > push.sifted;
    const uint own = sum_of_lengths(search.lengths, search.lane, lanes);
    const bool listed = many && search.lane == 0;
    uint place = listed ? atomicAdd(shared_vertices, 1) : !many && own > 0 ? atomicAdd(shared_candidates, own) : 0;
    barrier();
    if (thread == 0)
    {
        reserve(shared_vertices, VOILE_PAIR_FIND, push.lanes);
        reserve(shared_candidates, VOILE_PAIR_SIFT, 1);
    }
    barrier();
    if (listed)
        searching_vertices[shared_vertices + place] = vertex;
    if (many)
        return;
    for (uint list = search.lane; list < VOILE_PAIR_LEAF; list += lanes)
        for (uint k = 0; k < length_of(search.lengths, list); ++k)
            candidate_places[shared_candidates + place++] = candidate_place(vertex, list, k);
}
