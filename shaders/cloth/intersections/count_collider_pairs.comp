#version 460
#extension GL_GOOGLE_include_directive : require
// Counts the pairs of cloth and collider that intersect at the end of the step: an edge of one and a triangle of the
// other for meshes and boxes, a triangle of the cloth and the solid for the rest. A thread takes a triangle of a cloth
// through all colliders that share a layer.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/statistics_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(cloth_trees)) readonly buffer ClothTrees { TreeRecord cloth_trees[]; };
layout(VOILE_BINDING(cloth_leaves)) readonly buffer ClothLeaves { PaddedLeaf cloth_leaves[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(bvh_triangles)) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(VOILE_BINDING(bvh_edges)) readonly buffer BvhEdges { uint bvh_edges[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(padded_leaves)) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(intersections)) buffer Intersections { uint intersections[]; };
layout(VOILE_BINDING(intersection_counts)) buffer IntersectionCounts { IntersectionCounters intersection_counts[]; };

layout(push_constant, std430) uniform Push { IntersectionPush push; };

#include "colliders/collider_pose.glsl"
#include "intersections/cloth_triangle.glsl"
#include "intersections/tally.glsl"
#include "intersections/solid_triangle.glsl"

// Of a position that is transformed between the world and the space of a collider, relative to the largest coordinate
// involved. Two rotations by a quaternion that is of unit length to rounding take less than 60 roundings of 2^-23.
const float k_pose_error = 64.0 / 8388608;

// A triangle of a cloth, seen from a collider.
struct PairQuery
{
    ClothTriangle cloth;
    uint collider;
    uint flags; // of the collider
    Box box;    // around the triangle, in the space of the collider, grown by the rounding of the pose
    float error; // m, of a position of the triangle there
    vec3 corners[3]; // of the triangle there
    Tally tally;
};

// A triangle of a collider, in its space.
struct ColliderTriangle
{
    vec3 corners[3];
    uint edges; // that it owns, one bit each
};

// The definition of a vertex of a collider in the world at the end of the step. Every operation rounds to float.
vec3 cross_rounded(vec3 a, vec3 b)
{
    precise const vec3 left = a.yzx * b.zxy;
    precise const vec3 right = a.zxy * b.yzx;
    precise const vec3 result = left - right;
    return result;
}

vec3 world_vertex(PairQuery query, vec3 v)
{
    precise vec3 result;
    if (!is_moved(query.flags))
    {
        result = colliders[query.collider].origin + v;
        return result;
    }
    const ColliderMotion motion = collider_motions[query.collider];
    precise const vec3 inner = cross_rounded(motion.rotation_to.xyz, v) + motion.rotation_to.w * v;
    precise const vec3 turned = v + 2 * cross_rounded(motion.rotation_to.xyz, inner);
    result = motion.origin + (motion.offset_to + turned);
    return result;
}

void test_pair(inout PairQuery query, ColliderTriangle collider)
{
    const ClothTriangle cloth = query.cloth;
    vec3 world[3];
    for (uint i = 0; i < 3; ++i)
        world[i] = snapped(world_vertex(query, collider.corners[i]));
    if (!overlap(triangle_box(world[0], world[1], world[2]), box_of(cloth)))
        return;
    const uint edges = cloth.edges | collider.edges << 3;
    for (uint i = 0; i < 6; ++i)
    {
        if ((edges & 1u << i) == 0)
            continue;
        const uint a = i % 3;
        const uint b = (i + 1) % 3;
        EdgeTriangle pair;
        for (uint k = 0; k < 3; ++k)
            pair.points[k] = i < 3 ? world[k] : cloth.corners[k];
        pair.points[3] = i < 3 ? cloth.corners[a] : world[a];
        pair.points[4] = i < 3 ? cloth.corners[b] : world[b];
        if (overlap(triangle_box(pair.points[0], pair.points[1], pair.points[2]),
                    box_around(pair.points[3], pair.points[4])) &&
            count(query.tally, intersect(pair)))
            mark(i < 3 ? uvec3(cloth.vertices[a], cloth.vertices[b], cloth.vertices[b]) : cloth.vertices,
                 VOILE_INTERSECTS_COLLIDER);
    }
}

ColliderTriangle collider_triangle(PairQuery query, uint index)
{
    if (!is_deforming(query.flags))
    {
        const BvhTriangle t = bvh_triangles[index];
        return ColliderTriangle(vec3[](t.a, t.b, t.c), bvh_edges[index]);
    }
    const PaddedLeaf leaf = padded_leaves[index];
    const uvec3 corners = collider_motions[query.collider].first_to + leaf.corners;
    return ColliderTriangle(vec3[](deforming_positions[corners.x].xyz, deforming_positions[corners.y].xyz,
                                   deforming_positions[corners.z].xyz),
                            owned_edges(leaf));
}

bool enters_node(PairQuery query, Box node) { return overlap(query.box, node); }

void visit_leaf(inout PairQuery query, uint first, uint count)
{
    for (uint i = first; i < first + count; ++i)
        test_pair(query, collider_triangle(query, i));
}

#define VOILE_QUERY PairQuery
#include "colliders/mesh_traversal.glsl"

// Corner k of a box has its upper coordinate along axis i if bit i of k is set. Each face is cut between its two
// corners with an even number of bits. So each triangle has one corner with an odd number, and two of its neighbors. It
// owns the edge to the first one, and the cut if its odd corner is the smaller one of the face.
ColliderTriangle box_triangle(vec3 half_size, uint index)
{
    const uvec4 odd_corners = uvec4(1, 2, 4, 7);
    const uint corner = odd_corners[index / 3];
    const uint bit_a = 1u << index % 3;
    const uint bit_b = 1u << (index + 1) % 3;
    const uvec3 corners = uvec3(corner, corner ^ bit_a, corner ^ bit_b);
    ColliderTriangle result;
    for (uint i = 0; i < 3; ++i)
        result.corners[i] = mix(-half_size, half_size, notEqual(corners[i] & uvec3(1, 2, 4), uvec3(0)));
    result.edges = 1u | (corner < (corner ^ bit_a ^ bit_b) ? 2u : 0u);
    return result;
}

float largest(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

// The triangle in the space of a collider at the end of the step.
void enter_collider(inout PairQuery query, uint index, ColliderRecord collider)
{
    const ColliderMotion motion = collider_motions[index];
    const bool moved = is_moved(collider.flags);
    const vec3 origin = moved ? motion.origin : collider.origin;
    const Pose pose = Pose(motion.rotation_to, motion.offset_to);
    float size = largest(origin) + largest(motion.offset_to) + collider.extent + largest(collider.shape.xyz);
    float local_size = 0;
    query.collider = index;
    query.flags = collider.flags;
    for (uint i = 0; i < 3; ++i)
    {
        precise const vec3 offset = query.cloth.corners[i] - origin;
        query.corners[i] = moved ? to_collider(pose, offset) : offset;
        size = max(size, largest(query.cloth.corners[i]));
        local_size = max(local_size, largest(offset));
    }
    // Of vertices of the collider in the world, too, and of snapped ones.
    const float far_error = k_pose_error * (size + local_size) + k_unit;
    query.box = grown(triangle_box(query.corners[0], query.corners[1], query.corners[2]), far_error);
    query.error = (moved ? k_pose_error : k_solid_error) * (local_size + largest(motion.offset_to));
}

int intersect_solid(PairQuery query, ColliderRecord collider)
{
    const vec4 shape = collider.shape;
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return intersect_half_space(shape.xyz, shape.w, query.corners, query.error + k_solid_error * abs(shape.w));
    const vec3 axis = collider.kind == VOILE_COLLIDER_CAPSULE ? shape.xyz : vec3(0);
    const vec3 reach = abs(axis) + shape.w;
    if (!overlap(query.box, grown(Box(-reach, reach), query.error)))
        return k_apart;
    return intersect_capsule(axis, shape.w, query.corners, query.error + k_solid_error * largest(reach));
}

void test_collider(inout PairQuery query, ColliderRecord collider)
{
    if (collider.kind == VOILE_COLLIDER_MESH)
        traverse(query, collider);
    else if (collider.kind == VOILE_COLLIDER_BOX)
    {
        if (overlap(query.box, Box(-collider.shape.xyz, collider.shape.xyz)))
            for (uint i = 0; i < 12; ++i)
                test_pair(query, box_triangle(collider.shape.xyz, i));
    }
    else if (count(query.tally, intersect_solid(query, collider)))
        mark(query.cloth.vertices, VOILE_INTERSECTS_COLLIDER);
}

void main()
{
    const TreeRecord tree = cloth_trees[push.first_tree + gl_WorkGroupID.y];
    const uint slot = slot_of(gl_GlobalInvocationID.x, push.levels);
    if (gl_GlobalInvocationID.x >= 1u << push.levels || slot >= tree.triangles)
        return;
    PairQuery query;
    query.cloth = cloth_triangle(tree.first_leaf + slot, tree.first_to);
    query.tally = Tally(0, 0);
    if (!is_finite(query.cloth))
        return;
    const uint layers = cloths[tree.cloth].layers;
    for (uint i = 0; i < push.colliders; ++i)
    {
        const ColliderRecord collider = colliders[i];
        if ((collider.layers & layers) == 0)
            continue;
        enter_collider(query, i, collider);
        test_collider(query, collider);
    }
    query.tally.uncertain += runs_loops() ? 0 : 1;
    if (query.tally.pairs + query.tally.uncertain == 0)
        return;
    atomicAdd(intersection_counts[0].collider_pairs, query.tally.pairs);
    atomicAdd(intersection_counts[0].uncertain_pairs, query.tally.uncertain);
}
