#version 460
#extension GL_GOOGLE_include_directive : require
// Brings out what is inside a closed mesh, once a step before its first substep. One thread a vertex.
//
// What lies on the right side of a mesh, contact keeps there. This is for what begins inside: a cloth made that way or moved
// there, a collider added over it, surfaces that closed upon it. Out of a mesh leads a field: the sum of the six directions
// along the axes, each over the distance at which it leaves the mesh for good. Near a face it is the face's normal, in an
// ellipsoid the normal of the smaller one around its centre that goes through the vertex; and it has no jump where the
// nearest place of the surface has one. Of it, what is along the cloth's normal counts most: sheets go out in one piece,
// and are not torn apart in the middle. A vertex goes push.reach in a step, and no more than half of the cloth's spacing, or
// neighbours that go different ways would stretch the cloth into a tangle. It gets no velocity from that. Inside, it has the
// surface's, and does not fall.
// Reads: cloths, chunks, normals, colliders and their motions, hierarchies. Writes: state, of the vertices inside; if there are
// any, the size of the next step's dispatch.
#include "bvh_layout.h"
#include "cloth_layout.h"
#include "padded_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint COLLIDERS_MOVE = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 4, std430) readonly buffer Normals { vec4 normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 6, std430) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(set = 0, binding = 7, std430) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 8, std430) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(set = 0, binding = 9, std430) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(set = 0, binding = 10, std430) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(set = 0, binding = 11, std430) readonly buffer DeformingPositions { vec4 deforming_positions[]; };

layout(set = 0, binding = 12, std430) buffer NextDispatch { uint next_dispatch[]; };

layout(push_constant, std430) uniform Push { RecoverPush push; };

#include "chunk.glsl"
#include "collider_pose.glsl"
#include "convex.glsl"
#include "solid_query.glsl"

// What counts of the field across the cloth's normal where the surface is far: cloth that is pulled out across its normal
// only stretches.
#define VOILE_ACROSS 0.05
// By how much ways along the normal are preferred to those against it, as a share of all. In the middle of a solid the
// field along the normal vanishes, and neighbours must agree.
#define VOILE_BIAS 0.05
// The farthest that a vertex goes, as a share of the cloth's spacing.
#define VOILE_REACH 0.5
// Out of something thin it goes at once, along the field and this many times as far: springs would pull it back from half of
// the way.
#define VOILE_LEAP 2.0

const uint k_solid_flags = VOILE_COLLIDER_CLOSED | VOILE_COLLIDER_ONE_SIDED;

bool is_solid(ColliderRecord collider)
{
    return collider.kind == VOILE_COLLIDER_MESH && (collider.flags & k_solid_flags) == k_solid_flags;
}

// Where a point of the world is in a collider's space at the step's start, and back.
vec3 into_collider(uint c, uint flags, vec3 x) { return is_moved(flags) ? to_collider(pose_at(c, 0), x) : x; }
vec3 out_of_collider(uint c, uint flags, vec3 x) { return is_moved(flags) ? to_world(pose_at(c, 0), x) : x; }

bool in_box(ColliderRecord collider, vec3 local)
{
    if (!is_deforming(collider.flags))
        return boxes_overlap(local, local, collider.box_min, collider.box_max);
    const PaddedBox root = padded_boxes[collider.first_node];
    return boxes_overlap(local, local, root.min, root.max);
}

bool is_inside(uint c, ColliderRecord collider, vec3 local)
{
    return is_solid(collider) && in_box(collider, local) && line_winding(c, collider, local, 1) > 0;
}

// Whether a collider is in the way from a vertex to the place where it would come out: it is under another surface there,
// or another side of an open mesh.
bool obstructs(uint c, ColliderRecord collider, vec3 from, vec3 to)
{
    const vec3 end = into_collider(c, collider.flags, to);
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return plane_surface(collider, end).distance < 0;
    if (collider.kind != VOILE_COLLIDER_MESH)
        return convex_surface(collider, end).distance < 0;
    if (is_solid(collider))
        return is_inside(c, collider, end);
    return crosses(c, collider, into_collider(c, collider.flags, from), end, false);
}

bool leads_out(vec3 from, vec3 to, uint layers)
{
    for (uint c = 0; c < push.colliders; ++c)
        if ((colliders[c].layers & layers) != 0 && obstructs(c, colliders[c], from, to))
            return false;
    return true;
}

struct Field
{
    vec3 sum;   // 1/m
    float size; // 1/m, of all terms, whatever their directions
};

void add(inout Field field, vec3 direction, float distance)
{
    field.sum += direction / distance;
    field.size += 1 / distance;
}

// Of the ways that lead out of all colliders, or, where none does, of all.
Field field_at(uint c, ColliderRecord collider, vec3 x, vec3 local, float thickness, uint layers)
{
    Field all_ways = Field(vec3(0), 0);
    Field free_ways = Field(vec3(0), 0);
    for (int way = 0; way < 6; ++way)
    {
        const int axis = way / 2;
        line_winding(c, collider, local, axis);
        const float distance = max(solid.ends[way % 2], 1e-3 * thickness);
        vec3 direction = vec3(0);
        direction[axis] = way % 2 == 0 ? 1 : -1;
        add(all_ways, direction, distance);
        const vec3 end = local + (distance + 0.01 * thickness) * direction;
        if (leads_out(x, out_of_collider(c, collider.flags, end), layers))
            add(free_ways, direction, distance);
    }
    if (free_ways.size > 0)
        return free_ways;
    return all_ways;
}

vec3 direction_out(Field field, vec3 normal)
{
    const float along = dot(field.sum, normal);
    const vec3 across = field.sum - along * normal;
    const vec3 sum = (along + VOILE_BIAS * field.size) * normal + VOILE_ACROSS * across;
    const float size = length(sum);
    return size > 0 ? sum / size : vec3(0, 1, 0);
}

// m/s, of the collider's rigid motion at a place of its space; no faster than recovery is, or a collider that jumps would throw
// what it leaves behind.
vec3 surface_velocity(uint c, uint flags, vec3 place)
{
    if (!is_moved(flags))
        return vec3(0);
    const vec3 v = (to_world(pose_at(c, 1), place) - to_world(pose_at(c, 0), place)) / push.step;
    const float limit = push.reach / push.step;
    return v * min(1, limit / max(length(v), 1e-30));
}

// m, between neighbours; of a mesh the mean.
float spacing(uint cloth)
{
    const float a = cloths[cloth].springs[0].rest_length;
    return cloths[cloth].columns > 0 ? min(a, cloths[cloth].springs[1].rest_length) : a;
}

// Whether a way leads out of the mesh, and of all others; then to where: on the offset surface.
bool leaves(uint c, ColliderRecord collider, vec3 x, vec3 local, vec3 way, float thickness, uint layers, out vec3 to)
{
    if (!crosses(c, collider, local, local + way, true))
        return false;
    const vec3 surface = local + solid.crossing * way;
    to = surface + thickness * solid.normal;
    return leads_out(x, out_of_collider(c, collider.flags, surface + 0.01 * thickness * solid.normal), layers);
}

void recover(uint i, uint cloth, uint c, ColliderRecord collider, vec3 local)
{
    const float thickness = cloths[cloth].thickness;
    const uint layers = cloths[cloth].layers;
    const vec4 x = positions[i];
    const vec3 normal = is_moved(collider.flags) ? rotate_back(pose_at(c, 0).rotation, normals[i].xyz) : normals[i].xyz;
    const Field field = field_at(c, collider, x.xyz, local, thickness, layers);
    const float reach = min(push.reach, VOILE_REACH * spacing(cloth));
    const vec3 direction = direction_out(field, normal);
    const vec3 leap = VOILE_LEAP * reach / max(length(field.sum), 1e-30) * field.sum;
    const bool thin = crosses(c, collider, local, local - 2 * leap, true);
    vec3 to;
    if (!(thin && leaves(c, collider, x.xyz, local, leap, thickness, layers, to)) &&
        !leaves(c, collider, x.xyz, local, reach * direction, thickness, layers, to))
        to = local + reach * direction;
    positions[i] = vec4(out_of_collider(c, collider.flags, to), x.w);
    // What it falls in the step is taken back: fine cloth would fall faster than it is taken out.
    const vec3 v = surface_velocity(c, collider.flags, local) - 0.5 * push.step * push.gravity;
    velocities[i] = vec4(v, velocities[i].w);
}

void main()
{
    const ChunkVertex self = chunk_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const vec4 x = positions[self.index];
    if (x.w == 0)
        return;
    const uint layers = cloths[self.cloth].layers;
    for (uint c = 0; c < push.colliders; ++c)
    {
        const ColliderRecord collider = colliders[c];
        if (!is_solid(collider) || (collider.layers & layers) == 0)
            continue;
        const vec3 local = into_collider(c, collider.flags, x.xyz);
        if (!is_inside(c, collider, local))
            continue;
        recover(self.index, self.cloth, c, collider, local);
        atomicMax(next_dispatch[0], gl_NumWorkGroups.x);
        return;
    }
}
