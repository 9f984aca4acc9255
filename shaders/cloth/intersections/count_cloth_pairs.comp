#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the pairs of an edge and a triangle of cloths that intersect: within a cloth, and between cloths that share a
// layer. A thread takes the edges that a triangle owns through the hierarchies of all cloths. Pairs with a common
// vertex are left out.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/statistics_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(cloth_trees)) readonly buffer ClothTrees { TreeRecord cloth_trees[]; };
layout(VOILE_BINDING(cloth_leaves)) readonly buffer ClothLeaves { PaddedLeaf cloth_leaves[]; };
layout(VOILE_BINDING(cloth_boxes)) readonly buffer ClothBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(intersections)) buffer Intersections { uint intersections[]; };
layout(VOILE_BINDING(intersection_counts)) buffer IntersectionCounts { IntersectionCounters intersection_counts[]; };

layout(push_constant, std430) uniform Push { IntersectionPush push; };

#include "intersections/cloth_triangle.glsl"

// The edges of a triangle.
struct EdgesQuery
{
    ClothTriangle edges;
    Box box;           // around the edges that it owns
    uint first_vertex; // of the cloth whose triangles they are tested against
    Tally tally;
};

bool enters_node(EdgesQuery query, Box node) { return overlap(query.box, node); }

void test_edges(inout EdgesQuery query, ClothTriangle other)
{
    const ClothTriangle own = query.edges;
    for (uint i = 0; i < 3; ++i)
    {
        const uint j = (i + 1) % 3;
        const uvec2 ends = uvec2(own.vertices[i], own.vertices[j]);
        const bool connected = any(equal(uvec3(ends.x), other.vertices)) || any(equal(uvec3(ends.y), other.vertices));
        if ((own.edges & 1u << i) == 0 || connected ||
            !overlap(box_around(own.corners[i], own.corners[j]), box_of(other)))
            continue;
        const EdgeTriangle pair = EdgeTriangle(
            vec3[](other.corners[0], other.corners[1], other.corners[2], own.corners[i], own.corners[j]));
        if (count(query.tally, intersect(pair)))
        {
            mark(uvec3(ends, ends.y), VOILE_INTERSECTS_CLOTH);
            mark(other.vertices, VOILE_INTERSECTS_CLOTH);
        }
    }
}

// Always one triangle.
void visit_leaf(inout EdgesQuery query, uint slot, uint count)
{
    const ClothTriangle other = cloth_triangle(slot, query.first_vertex);
    if (is_finite(other))
        test_edges(query, other);
}

#define VOILE_QUERY EdgesQuery
#include "colliders/padded.glsl"

Box edges_box(ClothTriangle t)
{
    Box box = Box(vec3(uintBitsToFloat(0x7f800000u)), vec3(uintBitsToFloat(0xff800000u)));
    for (uint i = 0; i < 3; ++i)
        if ((t.edges & 1u << i) != 0)
            box = joined(box, box_around(t.corners[i], t.corners[(i + 1) % 3]));
    return box;
}

void main()
{
    const TreeRecord tree = cloth_trees[push.first_tree + gl_WorkGroupID.y];
    const uint slot = slot_of(gl_GlobalInvocationID.x, push.levels);
    if (gl_GlobalInvocationID.x >= 1u << push.levels || slot >= tree.triangles)
        return;
    EdgesQuery query;
    query.edges = cloth_triangle(tree.first_leaf + slot, tree.first_to);
    query.box = grown(edges_box(query.edges), k_unit); // the hierarchy is of coordinates before they are snapped
    query.tally = Tally(0, 0);
    if (query.edges.edges == 0 || !is_finite(query.edges))
        return;
    const uint layers = cloths[tree.cloth].layers;
    for (uint i = 0; i < push.trees; ++i)
    {
        const TreeRecord other = cloth_trees[i];
        query.first_vertex = other.first_to;
        if (other.cloth == tree.cloth || (cloths[other.cloth].layers & layers) != 0)
            traverse_padded(query, other.first_box, other.first_leaf, other.triangles);
    }
    if (query.tally.pairs == 0)
        return;
    atomicAdd(intersection_counts[0].cloth_pairs, query.tally.pairs);
    atomicAdd(intersection_counts[0].uncertain_pairs, query.tally.uncertain);
}
