#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Finds where cloths that collide with themselves intersect when a step starts, and directions out of it.
//
// The lines of intersection are to become shorter (Volino and Magnenat-Thalmann 2006, "Resolving surface collisions
// through intersection contour minimization"). Where an edge of triangle A crosses triangle T, the line of intersection
// of A and T begins. Its direction R leads from the edge into A. If the edge moves by d relative to T, its point in the
// plane of T, which has the normal n, moves by d - e (d n) / (e n) with the edge's direction e, and the line becomes
// shorter by the part of that along R. The gradient is R - (e R) / (e n) n.
//
// A thread takes the edges of a triangle through the hierarchies of all such cloths. An edge between two triangles is
// taken twice, each time with the line in one of them. Sums are of integers, so their order does not matter.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"
#include "shared/statistics_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; };
layout(VOILE_BINDING(cloth_trees)) readonly buffer ClothTrees { TreeRecord cloth_trees[]; };
layout(VOILE_BINDING(cloth_leaves)) readonly buffer ClothLeaves { PaddedLeaf cloth_leaves[]; };
layout(VOILE_BINDING(cloth_boxes)) readonly buffer ClothBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(tangles)) buffer Tangles { Tangle tangles[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { IntersectionPush push; };

#include "intersections/cloth_triangle.glsl"
#include "pairs/pair_tree.glsl"
#include "shared/separation.glsl"
#include "shared/step_input.glsl"

#define VOILE_TAKEN_EDGES(t) 7u
#define VOILE_FOUND Found

// The sine of the angle between an edge and a triangle below which the gradient grows no more.
const float k_least_sine = 0.2;
// Of the size of a pair: parts nearer than this touch.
const float k_touch = 1e-6;
// Parts farther apart than this do not, whatever rounding does.
const float k_near = 1e-3;

struct Found
{
    uint cloth; // of the triangle
    uint other; // the cloth of the traversal
    uint pairs; // of an edge that the triangle owns
};

// An edge and a triangle, relative to the edge's first end.
struct Near
{
    vec3 q; // m, the edge's second end
    vec3 t[3];
    float size; // m
};

Near near_of(vec3 p, vec3 q, vec3 a, vec3 b, vec3 c)
{
    Near near;
    near.q = q - p;
    near.t = vec3[](a - p, b - p, c - p);
    near.size = max(length(near.q), max(length(near.t[0]), max(length(near.t[1]), length(near.t[2]))));
    return near;
}

// m: between an end of the edge and the triangle, or the edge and a side.
float border_distance(Near near)
{
    const vec3 t[3] = near.t;
    float least = min(length(nearest_points(false, vec3[](vec3(0), t[0], t[1], t[2])).apart),
                      length(nearest_points(false, vec3[](near.q, t[0], t[1], t[2])).apart));
    for (uint i = 0; i < 3; ++i)
        least = min(least, length(nearest_points(true, vec3[](vec3(0), near.q, t[i], t[(i + 1) % 3])).apart));
    return least;
}

// Whether the exact predicate is to decide. It takes long for points of one plane, as in flat cloth.
bool may_intersect(Near near)
{
    const vec3 area = cross(near.t[1] - near.t[0], near.t[2] - near.t[0]);
    const vec2 heights = vec2(dot(-near.t[0], area), dot(near.q - near.t[0], area));
    const float least = k_near * near.size * length(area);
    if (min(heights.x, heights.y) > least || max(heights.x, heights.y) < -least)
        return false;
    return (min(heights.x, heights.y) < -least && max(heights.x, heights.y) > least) ||
           border_distance(near) <= k_near * near.size;
}

// Parts of a mesh that touch where it starts, as along a seam that is not merged, are no pair (find_pairs.comp).
bool touch_at_start(Found found, uvec2 edge, uvec3 triangle)
{
    if (cloths[found.cloth].columns > 0 || found.other != found.cloth)
        return false;
    const Near near = near_of(start[edge.x].xyz, start[edge.y].xyz, start[triangle.x].xyz, start[triangle.y].xyz,
                              start[triangle.z].xyz);
    return border_distance(near) <= k_touch * near.size;
}

// The direction in which the edge (p, q) of a triangle with the third corner c shortens the line of intersection with a
// triangle whose unit normal is n. 0: the triangles are parallel, or have no area.
vec3 shortening_direction(vec3 p, vec3 q, vec3 c, vec3 n)
{
    const vec3 edge = q - p;
    const vec3 own = cross(edge, c - p);
    const vec3 line = cross(own, n);
    if (length(line) <= 1e-4 * length(own))
        return vec3(0);
    const vec3 e = edge / length(edge);
    const vec3 inward = (c - p) - dot(c - p, e) * e;
    const vec3 along = normalize(line) * (dot(line, inward) < 0 ? -1 : 1);
    const float sine = dot(e, n);
    return along - dot(e, along) / (sine < 0 ? min(sine, -k_least_sine) : max(sine, k_least_sine)) * n;
}

void add(uint vertex, vec3 direction)
{
    const ivec3 words = ivec3(roundEven(direction / VOILE_TANGLE_UNIT));
    [[unroll]] for (uint k = 0; k < 3; ++k)
        atomicAdd(tangles[vertex].direction[k], words[k]);
    atomicAdd(tangles[vertex].pairs, 1);
}

// The edge's ends move one way, the corners of the other triangle the opposite way, each by its weight in the point
// that both share.
void take_pair(inout Found found, ClothTriangle own, uint i, ClothTriangle other)
{
    const uint j = (i + 1) % 3;
    const vec3 p = own.corners[i];
    const vec3 q = own.corners[j];
    if (!may_intersect(near_of(p, q, other.corners[0], other.corners[1], other.corners[2])))
        return;
    const EdgeTriangle pair = EdgeTriangle(vec3[](other.corners[0], other.corners[1], other.corners[2], p, q));
    const uvec2 ends = uvec2(own.vertices[i], own.vertices[j]);
    if (intersect(pair) == k_apart || touch_at_start(found, ends, other.vertices))
        return;
    found.pairs += own.edges >> i & 1u;
    const vec3 a = other.corners[0];
    const vec3 area = cross(other.corners[1] - a, other.corners[2] - a);
    const vec3 n = area / max(length(area), 1e-30);
    const vec3 direction = shortening_direction(p, q, own.corners[(i + 2) % 3], n);
    const vec2 heights = vec2(dot(p - a, n), dot(q - a, n));
    const float at = clamp(heights.x / (heights.x == heights.y ? 1 : heights.x - heights.y), 0, 1);
    const vec3 point = mix(p, q, at);
    const vec3 weights = nearest_weights(a - point, other.corners[1] - point, other.corners[2] - point);
    add(ends.x, (1 - at) * direction);
    add(ends.y, at * direction);
    [[unroll]] for (uint k = 0; k < 3; ++k)
        add(other.vertices[k], -weights[k] * direction);
}

#include "intersections/cloth_edges.glsl"

// Of the workgroup. Guards keep cloth free of intersections, so nothing can have got into cloth unless a pair was forced or
// the host has changed something. What gets into it otherwise, as by rounding far from the origin, is found some steps later.
bool is_searched()
{
    const uint steps = pair_searches[VOILE_PAIR_UNTANGLED].entries;
    return steps == 0 || step_input.edited != 0 || gl_WorkGroupID.x % VOILE_TANGLE_PARTS == steps % VOILE_TANGLE_PARTS;
}

void main()
{
    TreeRecord tree;
    ClothTriangle triangle;
    if (!is_searched() || !own_triangle(tree, triangle) || !collides_with_itself(tree.cloth))
        return;
    EdgesQuery query = query_of(triangle, Found(tree.cloth, 0, 0));
    for (uint i = 0; i < push.trees; ++i)
    {
        query.found.other = cloth_trees[i].cloth;
        if (meets(tree.cloth, query.found.other))
            traverse_tree(query, cloth_trees[i]);
    }
    if (query.found.pairs > 0)
        atomicAdd(pair_searches[VOILE_PAIR_TANGLED].entries, query.found.pairs);
}
