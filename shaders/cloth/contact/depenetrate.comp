#version 460
#extension GL_GOOGLE_include_directive : require
// Depenetration: finds the exit for vertices that are inside a collider, once per step before its first substep. One
// thread per vertex.
//
// Contact keeps vertices on the right side of surfaces. This kernel is for vertices that begin inside: a cloth is
// created or moved there, a collider is added over it, surfaces close on it. The exit follows a field: the sum of the
// six directions along the axes, each divided by the distance at which it leaves the solid for good. Near a face the
// field is the face's normal. In an ellipsoid it is the normal of the concentric ellipsoid through the vertex. It is
// smooth where the nearest surface point jumps. The part of the field along the cloth's normal counts most, so that a
// sheet leaves in one piece and is not torn apart in the middle. The contact kernel moves the vertex in each substep:
// in jumps of a whole step neighbors would part so far that springs throw them.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(depenetrations)) buffer Depenetrations
{
    uint dispatch_sizes[2 * VOILE_DISPATCH_WORDS];
    Depenetration depenetrations[];
};
layout(VOILE_BINDING(normals)) readonly buffer Normals { vec4 normals[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(bvh_triangles)) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(padded_leaves)) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };

layout(VOILE_BINDING(next_votes)) buffer NextVotes { uint next_votes[]; }; // of each cloth
layout(VOILE_BINDING(last_votes)) readonly buffer LastVotes { uint last_votes[]; };
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };
layout(VOILE_BINDING(residuals)) readonly buffer Residuals { uvec2 residuals[]; };

layout(push_constant, std430) uniform Push { DepenetrationPush push; };

#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/convex.glsl"
#include "colliders/near_colliders.glsl"
#include "contact/solid_query.glsl"
#include "contact/exit_votes.glsl"

// m/s, towards the exit. With its own velocity (contact.comp) a vertex moves at 1.5 m/s at most.
const float k_exit_speed = 0.9;
// The weight of the field across the cloth's normal far from the surface: cloth pulled out along itself only stretches.
const float k_across = 0.05;
// The preference for one side of a cloth, as a fraction. In the middle of a solid the field along the normal vanishes,
// and neighbors must agree: they prefer the side to which most of the vertices in it went in the last step.
const float k_bias = 0.3;
const float k_first_bias = 0.02; // before there was a vote
// Weight of the mean direction of the cloth, relative to the vertex's own direction near the surface.
const float k_mean_weight = 1.0;
// Weight of the vertex's own direction, times spacing over depth. Neighbors whose directions differ part for as long as
// they are inside, so a sheet deep inside moves as one.
const float k_own_weight = 0.6;
// Over the thickness: solids nearer than this touch.
const float k_touching = 0.1;
const uint k_none = 0xffffffffu;
const float k_nowhere = 3e38; // m: there is no such exit
// The most overlapping solids that are searched for an exit.
const int k_most_overlaps = 8;

// Directions between the world and a collider's space at the step's start.
vec3 rotated_into(uint c, uint flags, vec3 v) { return is_moved(flags) ? rotate_back(pose_at(c, 0).rotation, v) : v; }
vec3 rotated_out_of(uint c, uint flags, vec3 v) { return is_moved(flags) ? rotate(pose_at(c, 0).rotation, v) : v; }

bool is_inside(Solid solid, vec3 local)
{
    if (is_convex(solid.collider))
        return convex_surface(solid.collider, local).distance < 0;
    return is_solid(solid.collider) && in_box(solid.collider, local) && line_exits(solid, local, 1).winding > 0;
}

// At the step's start, where all of this happens.
Solid solid_at(uint c) { return Solid(c, colliders[c], false); }

// A vertex of a cloth.
struct Vertex
{
    FinePosition x;
    uint cloth;
    uint layers;
    float thickness; // m
};

// Whether a collider obstructs an exit by a displacement, m: the exit is under another surface, or behind an open mesh.
bool obstructs(Solid solid, FinePosition from, vec3 displacement)
{
    const ColliderRecord collider = solid.collider;
    const vec3 start = into_collider(solid.index, collider.flags, from, 0);
    const vec3 end = start + rotated_into(solid.index, collider.flags, displacement);
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return plane_surface(collider, end).distance < 0;
    if (is_convex(collider))
        return convex_surface(collider, end).distance < 0;
    // One traversal for both kinds of meshes: each is inlined, and this kernel takes long to compile.
    const bool closed = is_solid(collider);
    if (closed && !in_box(collider, end))
        return false;
    SolidQuery query;
    if (closed)
        query = line_query(solid, end, 1);
    else
        query = segment_query(solid, start, end, false);
    traverse(query, collider);
    return closed ? query.winding > 0 : query.crossing <= 1;
}

bool is_free(Vertex vertex, vec3 displacement)
{
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, box_around(vertex.x.x, vertex.x.x + displacement));
    uint c;
    while (next_collider(walk, c))
        if ((colliders[c].layers & vertex.layers) != 0 && obstructs(solid_at(c), vertex.x, displacement))
            return false;
    return true;
}

// Finds a solid other than `excluded` that contains the vertex after a displacement, m. False: none.
bool other_solid(Vertex vertex, vec3 displacement, uint excluded, out uint c)
{
    const vec3 to = vertex.x.x + displacement;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, Box(to, to));
    while (next_collider(walk, c))
    {
        const Solid solid = solid_at(c);
        const uint flags = solid.collider.flags;
        if (c == excluded || !is_solid(solid.collider) || (solid.collider.layers & vertex.layers) == 0)
            continue;
        if (is_inside(solid, into_collider(c, flags, vertex.x, 0) + rotated_into(c, flags, displacement)))
            return true;
    }
    return false;
}

struct NearestExit
{
    vec3 direction; // unit
    float distance; // m
};

void join(inout NearestExit nearest, vec3 direction, float distance)
{
    if (distance < nearest.distance)
        nearest = NearestExit(direction, distance);
}

struct Field
{
    vec3 sum;    // 1/m
    float size;  // 1/m, the sum of the terms' lengths
    float width; // m, of the solid along the axis along which it is thinnest
    NearestExit free;
    NearestExit obstructed; // by another collider
};

// m, between neighboring vertices. The mean for a mesh.
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

// m: the distances along an axis, and against it, to the last exit of a line.
vec2 exits_along(Solid solid, vec3 local, int axis)
{
    if (is_convex(solid.collider))
    {
        vec3 direction = vec3(0);
        direction[axis] = 1;
        return vec2(convex_exit(solid.collider, local, direction), convex_exit(solid.collider, local, -direction));
    }
    const LineExits exits = line_exits(solid, local, axis);
    return vec2(exits.ahead, exits.behind);
}

// The field of the exits that no collider obstructs, or of all six if each is obstructed.
Field field_at(Solid solid, Vertex vertex, vec3 local)
{
    const NearestExit none = NearestExit(vec3(0), k_nowhere);
    Field all_exits = Field(vec3(0), 0, k_nowhere, none, none);
    Field free_exits = all_exits;
    for (int axis = 0; axis < 3; ++axis)
    {
        const vec2 exits = max(exits_along(solid, local, axis), vec2(1e-3 * vertex.thickness));
        all_exits.width = min(all_exits.width, exits.x + exits.y);
        for (int side = 0; side < 2; ++side)
        {
            vec3 direction = vec3(0);
            direction[axis] = side == 0 ? 1 : -1;
            add(all_exits, direction, exits[side]);
            const vec3 displacement = (exits[side] + 0.01 * vertex.thickness) * direction;
            if (is_free(vertex, rotated_out_of(solid.index, solid.collider.flags, displacement)))
            {
                add(free_exits, direction, exits[side]);
                join(all_exits.free, direction, exits[side]);
            }
            else
                join(all_exits.obstructed, direction, exits[side]);
        }
    }
    if (free_exits.size > 0)
    {
        all_exits.sum = free_exits.sum;
        all_exits.size = free_exits.size;
    }
    return all_exits;
}

vec3 direction_out(uint cloth, uint c, Votes votes, Field field, vec3 normal)
{
    const float along = dot(field.sum, normal);
    const vec3 across = field.sum - along * normal;
    const float bias = votes.side == 0 ? k_first_bias : k_bias * sign(votes.side);
    const float side = along + bias * field.size;
    vote_for_side(cloth, c, side / field.size);
    const vec3 sum = side * normal + k_across * across;
    const float size = length(sum);
    return size > 0 ? sum / size : vec3(0, 1, 0);
}

// The direction of the vertex, drawn towards the mean direction of the last step. Parts of a sheet that leave on different
// sides would tear it. `own`: weight of the vertex's own direction.
vec3 agreed_direction(uint cloth, uint c, uint flags, Votes votes, vec3 direction, float own)
{
    const float count = max(float(votes.count), 1);
    const vec3 mean = rotated_into(c, flags, votes.direction / (k_vote * count)); // of unit vectors: shorter if they differ
    const vec3 sum_of_both = own * direction + k_mean_weight * mean;
    const float size = length(sum_of_both);
    const vec3 chosen = size > 1e-3 ? sum_of_both / size : direction;
    vote_for_direction(cloth, c, rotated_out_of(c, flags, chosen));
    return chosen;
}

// m: the distance to the offset surface in a unit direction, at most `limit`.
float exit_of_one(Solid solid, vec3 local, vec3 direction, float thickness, float limit)
{
    if (is_convex(solid.collider))
        return min(convex_exit(solid.collider, local, direction) + thickness, limit);
    SolidQuery query = segment_query(solid, local, local + limit * direction, true); // its first exit
    traverse(query, solid.collider);
    if (!(query.crossing <= 1))
        return limit;
    return min(query.crossing * limit + thickness, limit);
}

// m: the same, out of all solids that overlap there. `local_direction`: in the space of the first solid, where the vertex
// is at `local`; `direction`: in the world.
float exit_of_all(Vertex vertex, Solid solid, vec3 local, vec3 local_direction, vec3 direction, float limit)
{
    float distance = 0;
    for (int i = 0; i <= k_most_overlaps; ++i)
    {
        distance += max(exit_of_one(solid, local, local_direction, vertex.thickness, limit - distance),
                        0.01 * vertex.thickness);
        uint other;
        if (distance >= limit || !other_solid(vertex, distance * direction, solid.index, other))
            break;
        solid = solid_at(other);
        const uint flags = solid.collider.flags;
        local = into_collider(other, flags, vertex.x, 0) + rotated_into(other, flags, distance * direction);
        local_direction = rotated_into(other, flags, direction);
    }
    return min(distance, limit);
}

// m, world: the displacement of collider c within the step at a point of its space.
vec3 step_displacement(uint c, vec3 local)
{
    return is_moved(colliders[c].flags) ? displacement(pose_at(c, 0), pose_change(c, 0, 1), local) : vec3(0);
}

// What obstructs an exit.
struct Obstacle
{
    float overlap;     // m, back from the exit to its surface; 0: there is none with an inside
    vec3 displacement; // m, of its surface within the step
};

// `displacement`: m, of the exit from the vertex; `direction`: unit, from the vertex to the exit; `excluded`: the solid of
// the exit; `limit`: m, of the overlap.
Obstacle obstacle_at(Vertex vertex, vec3 displacement, vec3 direction, uint excluded, float limit)
{
    const vec3 to = vertex.x.x + displacement;
    Obstacle result = Obstacle(0, vec3(0));
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, Box(to, to));
    uint c;
    while (next_collider(walk, c))
    {
        const Solid solid = solid_at(c);
        const uint flags = solid.collider.flags;
        if (c == excluded || (solid.collider.layers & vertex.layers) == 0)
            continue;
        const vec3 local = into_collider(c, flags, vertex.x, 0) + rotated_into(c, flags, displacement);
        const vec3 back = -rotated_into(c, flags, direction);
        float overlap = 0;
        if (solid.collider.kind == VOILE_COLLIDER_PLANE)
            overlap = max(-plane_surface(solid.collider, local).distance, 0) / max(dot(back, solid.collider.shape.xyz), 0.1);
        else if (is_solid(solid.collider) && is_inside(solid, local))
            overlap = exit_of_one(solid, local, back, 0, limit);
        if (overlap > result.overlap)
            result = Obstacle(overlap, step_displacement(c, local));
    }
    return result;
}

// Whether surfaces have closed on the vertex. Then it stays halfway between them, so that they release it where it was.
// `local`: of the vertex in the solid's space; `velocity`: m/s, world, relative to the solid.
bool is_pinched(Vertex vertex, Solid solid, vec3 local, Field field, out vec3 velocity)
{
    velocity = vec3(0);
    if (field.free.distance < min(field.obstructed.distance, vertex.thickness))
        return false;
    const vec3 direction = rotated_out_of(solid.index, solid.collider.flags, field.obstructed.direction);
    const float exit = field.obstructed.distance + 0.01 * vertex.thickness;
    const Obstacle obstacle =
        obstacle_at(vertex, exit * direction, direction, solid.index, 2 * (exit + field.width));
    if (obstacle.overlap == 0)
        return false;
    const float parting = dot(obstacle.displacement - step_displacement(solid.index, local), direction);
    const float most = k_exit_speed * push.step;
    velocity = clamp(exit + 0.5 * (parting - obstacle.overlap), -most, most) / push.step * direction;
    return true;
}

// The rest of the exit at full speed is divided evenly between the last two steps. Full steps would end beside the
// offset surface. `normal`: of the cloth, world.
Depenetration depenetration_of(Vertex vertex, uint c, vec3 normal)
{
    const Solid solid = solid_at(c);
    const uint flags = solid.collider.flags;
    const vec3 local = into_collider(c, flags, vertex.x, 0);
    const Field field = field_at(solid, vertex, local);
    const uint began = VOILE_VOTE_WORDS * vertex.cloth + VOILE_VOTE_BEGAN;
    const bool entered = last_votes[began] == 0 && field.obstructed.distance < k_nowhere; // between colliders
    vec3 velocity;
    if (entered && is_pinched(vertex, solid, local, field, velocity))
        return Depenetration(velocity, c + 1);
    atomicOr(next_votes[began], last_votes[began]);
    const float size = length(field.sum);
    // In a solid thinner than the cloth's spacing a vertex has no neighbors to agree with. Between colliders the exit along
    // the cloth's normal may lead all through a solid.
    const bool nearest = entered && field.free.distance < k_nowhere;
    const bool alone = nearest || (field.width < spacing(vertex.cloth) && size > 0);
    const float own = clamp(k_own_weight * spacing(vertex.cloth) * field.size, 0, 1);
    const Votes votes = votes_for(vertex.cloth, c, k_touching * vertex.thickness);
    const vec3 direction =
        nearest ? field.free.direction
        : alone ? field.sum / size
                : agreed_direction(vertex.cloth, c, flags, votes,
                                   direction_out(vertex.cloth, c, votes, field, rotated_into(c, flags, normal)), own);
    const float most = k_exit_speed * push.step;
    const vec3 world = rotated_out_of(c, flags, direction);
    const float distance = exit_of_all(vertex, solid, local, direction, world, 2 * most);
    const float step_distance = distance < most ? distance : distance < 2 * most ? 0.5 * distance : most;
    // Without a vote neighbors may differ, so the first step only votes.
    const bool agreed = alone || votes.count > 0;
    return Depenetration(agreed ? step_distance / push.step * world : vec3(0), c + 1);
}

Depenetration find_depenetration(uint i, uint cloth)
{
    const FinePosition x = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    const Vertex vertex = Vertex(x, cloth, cloths[cloth].layers, cloths[cloth].thickness);
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, Box(x.x, x.x));
    uint first = k_none;
    uint c;
    while (positions[i].w > 0 && next_collider(walk, c))
    {
        const Solid solid = solid_at(c);
        if (!is_solid(solid.collider) || (solid.collider.layers & vertex.layers) == 0 ||
            !is_inside(solid, into_collider(c, solid.collider.flags, x, 0)))
            continue;
        note_inside(cloth, c);
        first = min(first, c);
    }
    return first == k_none ? Depenetration(vec3(0), 0) : depenetration_of(vertex, first, normals[i].xyz);
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists || self.asleep)
        return;
    const Depenetration depenetration = find_depenetration(self.index, self.cloth);
    depenetrations[self.index] = depenetration;
    if (depenetration.solid != 0)
        atomicMax(dispatch_sizes[push.dispatch_word], gl_NumWorkGroups.x);
}
