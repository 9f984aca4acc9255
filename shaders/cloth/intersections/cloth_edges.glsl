// Traverses the hierarchies of cloths with the edges of a triangle.
//
// The including kernel declares cloths[], positions[], cloth_trees[], cloth_leaves[], padded_boxes[] and `push`
// (IntersectionPush), includes cloth_triangle.glsl before, and defines
//   VOILE_TAKEN_EDGES(t): the edges of a ClothTriangle that it takes, one bit each;
//   VOILE_FOUND, a struct with what is found;
//   void take_pair(inout VOILE_FOUND found, ClothTriangle own, uint i, ClothTriangle other): edge i of one triangle and
//   another triangle, whose boxes overlap and which have no vertex in common.
#ifndef VOILE_CLOTH_EDGES_GLSL
#define VOILE_CLOTH_EDGES_GLSL

#include "colliders/padded_box.glsl"

struct EdgesQuery
{
    ClothTriangle edges;
    Box box;           // around the edges that are taken
    uint first_vertex; // of the cloth whose triangles they are tested against
    // Leaves with edges that overlap them, until all leaves that wait are visited: a slot, and three bits of edges above it. So the
    // exact predicate stands in no loop over leaves, which CPU devices would execute for each.
    uint overlaps[k_waiting_leaves];
    uint overlapping;
    VOILE_FOUND found;
};

const uint k_slot_bits = 29;

bool enters_node(EdgesQuery query, Box node) { return overlap(query.box, node); }

// Always one triangle.
void visit_leaf(inout EdgesQuery query, uint slot, uint count)
{
    const ClothTriangle other = cloth_triangle(slot, query.first_vertex);
    const ClothTriangle own = query.edges;
    if (!is_finite(other))
        return;
    uint edges = 0;
    for (uint i = 0; i < 3; ++i)
    {
        const uint j = (i + 1) % 3;
        const bool connected =
            any(equal(uvec3(own.vertices[i]), other.vertices)) || any(equal(uvec3(own.vertices[j]), other.vertices));
        if ((VOILE_TAKEN_EDGES(own) & 1u << i) != 0 && !connected &&
            overlap(box_around(own.corners[i], own.corners[j]), box_of(other)))
            edges |= 1u << i;
    }
    if (edges != 0)
        query.overlaps[query.overlapping++] = slot | edges << k_slot_bits;
}

void take_overlaps(inout EdgesQuery query)
{
    uint taken = 0;
    uint edges = query.overlapping > 0 ? query.overlaps[0] >> k_slot_bits : 0;
    while (edges != 0)
    {
        const uint slot = query.overlaps[taken] & ((1u << k_slot_bits) - 1);
        take_pair(query.found, query.edges, findLSB(edges), cloth_triangle(slot, query.first_vertex));
        edges &= edges - 1;
        if (edges == 0 && ++taken < query.overlapping)
            edges = query.overlaps[taken] >> k_slot_bits;
    }
    query.overlapping = 0;
}

#define VOILE_QUERY EdgesQuery
#define VOILE_LEAVES_VISITED take_overlaps
#include "colliders/padded.glsl"

Box edges_box(ClothTriangle t)
{
    Box box = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u)));
    for (uint i = 0; i < 3; ++i)
        if ((VOILE_TAKEN_EDGES(t) & 1u << i) != 0)
            box = joined(box, box_around(t.corners[i], t.corners[(i + 1) % 3]));
    return box;
}

// The triangle of the thread. False: there is none.
bool own_triangle(out TreeRecord tree, out ClothTriangle triangle)
{
    tree = cloth_trees[push.first_tree + gl_WorkGroupID.y];
    const uint slot = slot_of(gl_GlobalInvocationID.x, push.levels);
    if (gl_GlobalInvocationID.x >= 1u << push.levels || slot >= tree.triangles)
        return false;
    triangle = cloth_triangle(tree.first_leaf + slot, tree.first_to);
    return VOILE_TAKEN_EDGES(triangle) != 0 && is_finite(triangle);
}

EdgesQuery query_of(ClothTriangle triangle, VOILE_FOUND nothing)
{
    EdgesQuery query;
    query.edges = triangle;
    query.box = grown(edges_box(triangle), k_unit); // the hierarchy is of coordinates before they are snapped
    query.overlapping = 0;
    query.found = nothing;
    return query;
}

void traverse_tree(inout EdgesQuery query, TreeRecord tree)
{
    query.first_vertex = tree.first_to;
    traverse_padded(query, tree.first_box, tree.first_leaf, tree.triangles);
}

#endif
