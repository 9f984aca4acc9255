#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the way out for vertices that are inside a collider, once a step before its first substep. One thread a vertex.
//
// What lies on the right side of a surface, contact keeps there. This is for what begins inside: a cloth made that way or moved
// there, a collider added over it, surfaces that closed upon it. Out of a solid leads a field: the sum of the six directions
// along the axes, each over the distance at which it leaves the solid for good. Near a face it is the face's normal, in an
// ellipsoid the normal of the smaller one around its center that goes through the vertex; and it has no jump where the
// nearest place of the surface has one. Of it, what is along the cloth's normal counts most: sheets go out in one piece,
// and are not torn apart in the middle. The contact pass takes the vertex along in each substep: in jumps of a whole step
// neighbors would part so far that springs throw them.
// Reads: cloths, patches, positions, residuals, normals, colliders and their motions, hierarchies, votes of the last step.
// Writes: depenetrations of all vertices; if any is inside, the size of the next step's dispatch and the votes of cloths.
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint COLLIDERS_MOVE = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Patches { Patch patches[]; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) buffer Depenetrations
{
    uint recovery_sizes[2 * VOILE_DISPATCH_WORDS];
    Depenetration depenetrations[];
};
layout(set = 0, binding = 4, std430) readonly buffer Normals { vec4 normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 6, std430) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(set = 0, binding = 7, std430) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 8, std430) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(set = 0, binding = 9, std430) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(set = 0, binding = 10, std430) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(set = 0, binding = 11, std430) readonly buffer DeformingPositions { vec4 deforming_positions[]; };

layout(set = 0, binding = 12, std430) buffer NextVotes { uint next_votes[]; }; // of each cloth
layout(set = 0, binding = 13, std430) readonly buffer LastVotes { uint last_votes[]; };
layout(set = 0, binding = 14, std430) readonly buffer NearColliders { uint near_colliders[]; };
layout(set = 0, binding = 15, std430) readonly buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { RecoverPush push; };

#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/convex.glsl"
#include "colliders/near_colliders.glsl"
#include "contact/solid_query.glsl"

// m/s, along the way out: with its own velocity (contact.comp) a vertex goes at 1.5 m/s at most.
#define VOILE_OUT_SPEED 0.9
// What counts of the field across the cloth's normal where the surface is far: cloth that is pulled out across its normal
// only stretches.
#define VOILE_ACROSS 0.05
// By how much one side of a cloth is preferred to the other, as a fraction of all. In the middle of a solid the field along the
// normal vanishes, and neighbors must agree: they take the side to which more of the cloth's vertices went in the last step.
#define VOILE_BIAS 0.3
#define VOILE_FIRST_BIAS 0.02 // before there was a vote
// Votes are integers, whose sum has no order.
#define VOILE_VOTE 1024
// Weight of the mean of directions, to that of the vertex's own near the surface.
#define VOILE_TOGETHER 1.0
// Weight of the vertex's own, times the spacing over the depth: neighbors whose directions differ part for as long as they are
// inside. So a sheet that is deep inside moves as one.
#define VOILE_OWN 0.6
const uint k_none = 0xffffffffu;
// Overlapping solids that are searched for an exit.
#define VOILE_MOST_OVERLAPS 8

// Of a direction, between the world and a collider's space at the step's start.
vec3 turned_into(uint c, uint flags, vec3 v) { return is_moved(flags) ? rotate_back(pose_at(c, 0).rotation, v) : v; }
vec3 turned_out_of(uint c, uint flags, vec3 v) { return is_moved(flags) ? rotate(pose_at(c, 0).rotation, v) : v; }

bool is_inside(uint c, ColliderRecord collider, vec3 local)
{
    if (is_convex(collider))
        return convex_surface(collider, local).distance < 0;
    return is_solid(collider) && in_box(collider, local) && line_winding(c, collider, local, 1) > 0;
}

// Whether a collider is in the way of a vertex that would come out by a displacement, m: it is under another surface there, or
// on another side of an open mesh.
bool obstructs(uint c, ColliderRecord collider, FinePosition from, vec3 displacement)
{
    const vec3 start = into_collider(c, collider.flags, from, 0);
    const vec3 end = start + turned_into(c, collider.flags, displacement);
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return plane_surface(collider, end).distance < 0;
    if (is_solid(collider))
        return is_inside(c, collider, end);
    return crosses(c, collider, start, end, false);
}

bool leads_out(FinePosition from, vec3 displacement, uint layers)
{
    const vec3 to = from.x + displacement;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, min(from.x, to), max(from.x, to));
    uint c;
    while (next_collider(walk, c))
        if ((colliders[c].layers & layers) != 0 && obstructs(c, colliders[c], from, displacement))
            return false;
    return true;
}

// Another solid than `but`, if any, that a vertex is inside of at a displacement, m.
bool other_solid(FinePosition from, vec3 displacement, uint layers, uint but, out uint c)
{
    const vec3 to = from.x + displacement;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, to, to);
    while (next_collider(walk, c))
    {
        const ColliderRecord collider = colliders[c];
        if (c == but || !is_solid(collider) || (collider.layers & layers) == 0)
            continue;
        if (is_inside(c, collider, into_collider(c, collider.flags, from, 0) +
                                       turned_into(c, collider.flags, displacement)))
            return true;
    }
    return false;
}

struct Field
{
    vec3 sum;   // 1/m
    float size; // 1/m, of all terms, whatever their directions
};

// m, between neighbors; of a mesh the mean.
float spacing(uint cloth)
{
    const float a = cloths[cloth].springs[0].rest_length;
    return cloths[cloth].columns > 0 ? min(a, cloths[cloth].springs[1].rest_length) : a;
}

void add(inout Field field, vec3 direction, float distance)
{
    field.sum += direction / distance;
    field.size += 1 / distance;
}

// m: how far it is along an axis, and against it, until a line is out of the solid for good.
vec2 line_exits(uint c, ColliderRecord collider, vec3 local, int axis)
{
    if (is_convex(collider))
    {
        vec3 direction = vec3(0);
        direction[axis] = 1;
        return vec2(convex_exit(collider, local, direction), convex_exit(collider, local, -direction));
    }
    line_winding(c, collider, local, axis);
    return vec2(solid.ends[0], solid.ends[1]);
}

// Of the ways that lead out of all colliders, or, where none does, of all.
// `width`: m, of the solid there, along the axis along which it is thinnest.
Field field_at(uint c, ColliderRecord collider, FinePosition x, vec3 local, float thickness, uint layers, out float width)
{
    width = 3e38;
    Field all_ways = Field(vec3(0), 0);
    Field free_ways = Field(vec3(0), 0);
    for (int axis = 0; axis < 3; ++axis)
    {
        const vec2 exits = max(line_exits(c, collider, local, axis), vec2(1e-3 * thickness));
        width = min(width, exits.x + exits.y);
        for (int way = 0; way < 2; ++way)
        {
            vec3 direction = vec3(0);
            direction[axis] = way == 0 ? 1 : -1;
            add(all_ways, direction, exits[way]);
            const vec3 displacement = (exits[way] + 0.01 * thickness) * direction;
            if (leads_out(x, turned_out_of(c, collider.flags, displacement), layers))
                add(free_ways, direction, exits[way]);
        }
    }
    if (free_ways.size > 0)
        return free_ways;
    return all_ways;
}

vec3 direction_out(uint cloth, Field field, vec3 normal)
{
    const float along = dot(field.sum, normal);
    const vec3 across = field.sum - along * normal;
    const int vote = int(last_votes[VOILE_VOTE_WORDS * cloth]);
    const float bias = vote == 0 ? VOILE_FIRST_BIAS : VOILE_BIAS * sign(vote);
    const float side = along + bias * field.size;
    atomicAdd(next_votes[VOILE_VOTE_WORDS * cloth], uint(int(VOILE_VOTE * side / field.size)));
    const vec3 sum = side * normal + VOILE_ACROSS * across;
    const float size = length(sum);
    return size > 0 ? sum / size : vec3(0, 1, 0);
}

// What a vertex goes by besides the field: the way that the cloth's vertices went in the last step. Where parts of a sheet
// would go out on different sides, they would tear it between them. `own`: weight of its own direction.
vec3 together(uint cloth, uint c, uint flags, vec3 direction, float own)
{
    const uint word = VOILE_VOTE_WORDS * cloth;
    const vec3 sum = vec3(int(last_votes[word + 1]), int(last_votes[word + 2]), int(last_votes[word + 3]));
    const float count = max(float(last_votes[word + VOILE_VOTE_COUNT]), 1);
    const vec3 mean = turned_into(c, flags, sum / (VOILE_VOTE * count)); // of unit vectors: shorter where they differ
    const vec3 way = own * direction + VOILE_TOGETHER * mean;
    const float size = length(way);
    const vec3 chosen = size > 1e-3 ? way / size : direction;
    const ivec3 vote = ivec3(VOILE_VOTE * turned_out_of(c, flags, chosen));
    atomicAdd(next_votes[word + 1], uint(vote.x));
    atomicAdd(next_votes[word + 2], uint(vote.y));
    atomicAdd(next_votes[word + 3], uint(vote.z));
    atomicAdd(next_votes[word + VOILE_VOTE_COUNT], 1);
    return chosen;
}

// m: how far it is in a unit direction to the offset surface; `reach` if it is at least that.
float way_out(uint c, ColliderRecord collider, vec3 local, vec3 direction, float thickness, float reach)
{
    if (is_convex(collider))
        return min(convex_exit(collider, local, direction) + thickness, reach);
    if (!crosses(c, collider, local, local + reach * direction, true))
        return reach;
    return min(solid.crossing * reach + thickness, reach);
}

// The same for all solids that overlap there. `direction`: world; `distance`: m, at which the vertex is out of solid c.
float exit_distance(uint c, FinePosition x, vec3 direction, float distance, float thickness, uint layers, float most)
{
    uint other;
    for (int i = 0; i < VOILE_MOST_OVERLAPS && distance < most && other_solid(x, distance * direction, layers, c, other); ++i)
    {
        const ColliderRecord collider = colliders[other];
        const vec3 local =
            into_collider(other, collider.flags, x, 0) + turned_into(other, collider.flags, distance * direction);
        const vec3 local_direction = turned_into(other, collider.flags, direction);
        distance += max(way_out(other, collider, local, local_direction, thickness, most - distance), 0.01 * thickness);
        c = other;
    }
    return min(distance, most);
}

// What is left of the way at full speed is shared out evenly between the last two steps: whole ones would end beside the offset
// surface.
Depenetration depenetration_of(uint i, uint cloth, uint c, FinePosition x)
{
    const ColliderRecord collider = colliders[c];
    const vec3 local = into_collider(c, collider.flags, x, 0);
    const float thickness = cloths[cloth].thickness;
    const uint layers = cloths[cloth].layers;
    const vec3 normal = turned_into(c, collider.flags, normals[i].xyz);
    float width;
    const Field field = field_at(c, collider, x, local, thickness, layers, width);
    const float size = length(field.sum);
    // In what is thinner than the cloth's spacing a vertex has no neighbors to agree with.
    const bool alone = width < spacing(cloth) && size > 0;
    const float own = clamp(VOILE_OWN * spacing(cloth) * field.size, 0, 1);
    const vec3 direction =
        alone ? field.sum / size : together(cloth, c, collider.flags, direction_out(cloth, field, normal), own);
    const float most = VOILE_OUT_SPEED * push.step;
    const vec3 world = turned_out_of(c, collider.flags, direction);
    const float out_of_one = way_out(c, collider, local, direction, thickness, 2 * most);
    const float distance = exit_distance(c, x, world, out_of_one, thickness, layers, 2 * most);
    const float step_distance = distance < most ? distance : distance < 2 * most ? 0.5 * distance : most;
    // Before there was a vote neighbors may differ: the first step is for that alone.
    const bool agreed = alone || last_votes[VOILE_VOTE_WORDS * cloth + VOILE_VOTE_COUNT] > 0;
    return Depenetration(agreed ? step_distance / push.step * world : vec3(0), c + 1);
}

Depenetration find_depenetration(uint i, uint cloth)
{
    const FinePosition x = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    const uint layers = cloths[cloth].layers;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, x.x, x.x);
    uint first = k_none;
    uint c;
    while (positions[i].w > 0 && next_collider(walk, c))
    {
        const ColliderRecord collider = colliders[c];
        if (!is_solid(collider) || (collider.layers & layers) == 0 ||
            !is_inside(c, collider, into_collider(c, collider.flags, x, 0)))
            continue;
        atomicOr(next_votes[VOILE_VOTE_WORDS * cloth + VOILE_VOTE_COLLIDERS], 1u << (c % 32));
        first = min(first, c);
    }
    return first == k_none ? Depenetration(vec3(0), 0) : depenetration_of(i, cloth, first, x);
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const Depenetration depenetration = find_depenetration(self.index, self.cloth);
    depenetrations[self.index] = depenetration;
    if (depenetration.solid != 0)
        atomicMax(recovery_sizes[push.recovery], gl_NumWorkGroups.x);
}
