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
#include "intersections/tally.glsl"

#define VOILE_TAKEN_EDGES(t) ((t).edges)
#define VOILE_FOUND Tally

void take_pair(inout Tally tally, ClothTriangle own, uint i, ClothTriangle other)
{
    const uint j = (i + 1) % 3;
    const EdgeTriangle pair = EdgeTriangle(
        vec3[](other.corners[0], other.corners[1], other.corners[2], own.corners[i], own.corners[j]));
    if (!count(tally, intersect(pair)))
        return;
    mark(uvec3(own.vertices[i], own.vertices[j], own.vertices[j]), VOILE_INTERSECTS_CLOTH);
    mark(other.vertices, VOILE_INTERSECTS_CLOTH);
}

#include "intersections/cloth_edges.glsl"

void main()
{
    TreeRecord tree;
    ClothTriangle triangle;
    if (!own_triangle(tree, triangle))
        return;
    EdgesQuery query = query_of(triangle, Tally(0, 0));
    const uint layers = cloths[tree.cloth].layers;
    for (uint i = 0; i < push.trees; ++i)
        if (cloth_trees[i].cloth == tree.cloth || (cloths[cloth_trees[i].cloth].layers & layers) != 0)
            traverse_tree(query, cloth_trees[i]);
    query.found.uncertain += runs_loops() ? 0 : 1;
    if (query.found.pairs + query.found.uncertain == 0)
        return;
    atomicAdd(intersection_counts[0].cloth_pairs, query.found.pairs);
    atomicAdd(intersection_counts[0].uncertain_pairs, query.found.uncertain);
}
