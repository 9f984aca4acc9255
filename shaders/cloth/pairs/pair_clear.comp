#version 460
#extension GL_GOOGLE_include_directive : require
// Whether vertices that collide with other cloth are clear of all colliders for some time, so that nothing but cloth can
// stop them or their neighbors, how fast those that are move, how anchors and colliders restrain the others, and where
// each cloth is. One thread per vertex.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_frame_of_one) const uint FRAME_OF_ONE = 1; // whether it finds the frame of a single cloth
const uint COLLIDERS_MOVE = 1;
const float k_unbounded = 1e30;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(bvh_triangles)) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(padded_leaves)) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(pair_flats)) writeonly buffer PairFlats { vec2 pair_flats[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

const uint k_values = 16;

#include "shared/finite.glsl"
#include "shared/patch.glsl"
#include "shared/step_input.glsl"
#include "pairs/clear.glsl"
#include "pairs/cloth_origin.glsl"
#include "pairs/fold.glsl"
#include "pairs/isolated.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/met_colliders.glsl"
#include "pairs/moving_frame.glsl"
#include "pairs/neighborhood.glsl"
#include "pairs/pair_tree.glsl"
#include "shared/ordered.glsl"

// What may move a vertex otherwise than its island.
struct Surroundings
{
    bool clear;      // nothing
    bool restrained; // a collider, or what holds the vertex
    Restraints restraints;
};

// How a cloth moves on average.
struct ClothMotion
{
    RigidMotion motion;
    vec3 origin;      // m
    bool wants_frame; // that of one cloth is not faster
};

ClothMotion motion_of(uint cloth)
{
    const MeanMotion mean = mean_motion(sums_of(pair_islands[cloth].frame_sums), pair_islands[cloth].vertices);
    const RigidMotion motion = rigid_motion(mean);
    return ClothMotion(motion, origin_of(cloth), push.cloths > 1 || is_worth_lists(mean_square(mean, motion)));
}

// Springs, tethers and bounds hold the vertex, or nothing moves it: its motion is not that of its island.
bool is_held(uint i, uint cloth)
{
    return positions[i].w == 0 || (uint(velocities[i].w) & VOILE_VERTEX_HELD) != 0 ||
           (cloths[cloth].flags & VOILE_CLOTH_ASLEEP) != 0;
}

// Edges and corners of colliders push vertices that are an edge of the cloth away.
Way way_of(uint i, uint cloth)
{
    const float thickness = cloths[cloth].thickness;
    const float margin = thickness + (k_neighborhood_radius + 1) * cloths[cloth].springs[0].rest_length;
    return Way(positions[i].xyz, velocities[i].xyz, step_input.list_time, margin, k_near * thickness);
}

// By all threads.
// `counts`: there is a vertex. `mean`: motion of the cloth.
Surroundings surroundings_of(PatchVertex self, ClothMotion mean, bool counts, uint thread)
{
    const uint i = self.index;
    const vec3 along = counts ? velocity_at(mean.motion, positions[i].xyz - mean.origin) : vec3(0);
    Surroundings around = Surroundings(false, counts, no_restraints(along, counts && mean.wants_frame));
    const bool held = counts && is_held(i, self.cloth);
    if (held)
        restrain(around.restraints, velocities[i].xyz);
    const bool moves = counts && !held;
    Way way = Way(vec3(0), vec3(0), 0, 0, 0);
    if (moves)
        way = way_of(i, self.cloth);
    find_swept_box(thread, moves, way);
    bool clear = moves;
    for (uint first = 0; first < push.colliders; first += gl_WorkGroupSize.x)
    {
        find_met(first, thread, cloths[self.cloth].layers);
        MetWalk walk = walk_met(moves);
        uint k;
        while ((clear || around.restraints.wanted) && next_met(walk, k))
            clear = is_clear_of(around.restraints, first + k, way) && clear;
    }
    around.clear = clear && (uint(velocities[i].w) & VOILE_VERTEX_BOUND) == 0;
    around.restrained = counts && !clear;
    return around;
}

// Of a vertex: its momentum and moment, its mass, whether it is clear, and restrained, and in any direction, and its box, the
// lower corner negated.
const uint k_part_sums = 10;

void part_of(PatchVertex self, Surroundings around, vec3 origin, out float part[k_values])
{
    const vec3 x = positions[self.index].xyz;
    const vec3 v = velocity_at_pass(velocities[self.index].xyz, cloths[self.cloth].flags);
    const float mass = around.clear ? 1 / (positions[self.index].w * cloths[self.cloth].pair_mass) : 0;
    for (uint k = 0; k < 3; ++k)
    {
        part[k] = mass * v[k];
        part[3 + k] = mass * (x[k] - origin[k]);
        part[k_part_sums + k] = -x[k];
        part[k_part_sums + 3 + k] = x[k];
    }
    part[6] = mass;
    part[7] = around.clear ? 1 : 0;
    part[8] = around.restrained ? 1 : 0;
    part[9] = around.restraints.diagonal != vec3(0) ? 1 : 0;
}

// The order does not depend on timing: groups add whole numbers.
void add_part(uint cloth, float part[k_values])
{
    const float unit = VOILE_PAIR_UNIT_SPEED * float(push.places);
    for (uint k = 0; k < 3; ++k)
    {
        atomicAdd(pair_islands[cloth].momentum[k], int(round(part[k] / unit)));
        atomicAdd(pair_islands[cloth].moment[k], int(round(part[3 + k] / unit)));
        atomicMax(pair_islands[cloth].low[k], ~ordered(-part[k_part_sums + k]));
        atomicMax(pair_islands[cloth].high[k], ordered(part[k_part_sums + 3 + k]));
    }
    atomicAdd(pair_islands[cloth].mass, uint(round(part[6] / (VOILE_PAIR_UNIT_MASS * float(push.places)))));
    atomicAdd(pair_islands[cloth].clear, uint(part[7]));
    atomicAdd(pair_islands[cloth].frame_sums.restrained, uint(part[8]));
}

// The restraints of a vertex. Along n they act at r, so m = r x n is a linear map of n. `lever`: that map.
void directions_part(Restraints restraints, mat3 lever, out float part[k_values])
{
    const mat3 mixed = symmetric(restraints.diagonal, restraints.beside) * transpose(lever);
    for (uint k = 0; k < 3; ++k)
    {
        part[VOILE_FRAME_DIRECTIONS + k] = restraints.diagonal[k];
        part[VOILE_FRAME_DIRECTIONS + 3 + k] = restraints.beside[k];
        for (uint l = 0; l < 3; ++l)
            part[VOILE_FRAME_MIXED + 3 * k + l] = mixed[k][l];
    }
    part[VOILE_FRAME_TURNS] = 0;
}

void drives_part(Restraints restraints, mat3 lever, out float part[k_values])
{
    const mat3 turns = lever * symmetric(restraints.diagonal, restraints.beside) * transpose(lever);
    const vec3 moments = lever * restraints.drives;
    for (uint k = 0; k < 3; ++k)
    {
        part[k] = diagonal_of(turns)[k];
        part[3 + k] = beside_of(turns)[k];
        part[VOILE_FRAME_DRIVES - VOILE_FRAME_TURNS + k] = restraints.drives[k];
        part[VOILE_FRAME_MOMENTS - VOILE_FRAME_TURNS + k] = moments[k];
    }
    part[VOILE_FRAME_SQUARES - VOILE_FRAME_TURNS] = restraints.squares;
    for (uint k = VOILE_FRAME_RESTRAINTS - VOILE_FRAME_TURNS; k < k_values; ++k)
        part[k] = 0;
}

// `first`: of the `count` sums of which this is a part.
void add_frame_part(uint cloth, float part[k_values], uint first, uint count)
{
    for (uint k = 0; k < count; ++k)
    {
        const ivec2 words = frame_words(part[k], first + k, gl_NumWorkGroups.x);
        if (words == ivec2(0))
            continue;
        atomicAdd(pair_islands[cloth].frame_sums.low[first + k], uint(words.x));
        atomicAdd(pair_islands[cloth].frame_sums.high[first + k], words.y);
    }
}

// By all threads.
void add_restraints(PatchVertex self, Restraints restraints, vec3 origin)
{
    const uint thread = gl_LocalInvocationID.x;
    const mat3 lever = cross_matrix(restraints.diagonal == vec3(0) ? vec3(0) : positions[self.index].xyz - origin);
    float part[k_values];
    directions_part(restraints, lever, part);
    fold(thread, k_values, part);
    if (thread == 0)
        add_frame_part(self.cloth, part, VOILE_FRAME_DIRECTIONS, VOILE_FRAME_TURNS);
    drives_part(restraints, lever, part);
    fold(thread, k_values, part);
    if (thread == 0)
        add_frame_part(self.cloth, part, VOILE_FRAME_TURNS, VOILE_FRAME_RESTRAINTS - VOILE_FRAME_TURNS);
}

shared ClothMotion shared_motion;
shared bool shared_restrained;

// By all threads.
void add_to_cloth(PatchVertex self, uint thread)
{
    if (thread == 0)
        shared_motion = motion_of(self.cloth);
    barrier();
    const ClothMotion mean = shared_motion;
    float values[k_values];
    for (uint k = 0; k < k_values; ++k)
        values[k] = k < k_part_sums ? 0 : -k_unbounded;
    // What is not finite would move the frame of all cloth near it.
    const bool counts = self.exists && !is_isolated(self) && is_finite(positions[self.index].xyz) &&
                        is_finite(velocities[self.index].xyz);
    const Surroundings around = surroundings_of(self, mean, counts, thread);
    if (counts)
        part_of(self, around, mean.origin, values);
    if (self.exists)
        pair_flats[self.index] = vec2(around.clear ? 1 : 0, 0);
    if (self.exists && self.index == cloths[self.cloth].first_vertex)
        for (uint k = 0; k < 3; ++k)
            pair_islands[self.cloth].frame_origin[k] = mean.origin[k];
    fold(thread, k_part_sums, values);
    if (thread == 0)
    {
        add_part(self.cloth, values);
        shared_restrained = values[9] > 0;
    }
    barrier();
    if (shared_restrained)
        add_restraints(self, around.restraints, mean.origin);
}

shared bool shared_last;
shared float shared_sums[VOILE_FRAME_SUMS];

// find_islands.comp finds the frame of islands. Where there is only one cloth, the last workgroup does, which saves a dispatch.
// Not on CPU devices, where all workgroups would execute it. By all threads.
void find_frame(uint thread)
{
    if (thread == 0)
    {
        memoryBarrierBuffer();
        shared_last = atomicAdd(pair_islands[0].arrived, 1) + 1 == gl_NumWorkGroups.x;
    }
    barrier();
    if (!shared_last)
        return;
    for (uint k = thread; k < VOILE_FRAME_SUMS; k += gl_WorkGroupSize.x) // atomically: other workgroups have added to them
        shared_sums[k] = frame_sum(atomicAdd(pair_islands[0].frame_sums.low[k], 0),
                                   atomicAdd(pair_islands[0].frame_sums.high[k], 0), k);
    barrier();
    if (thread != 0)
        return;
    const uint restrained = atomicAdd(pair_islands[0].frame_sums.restrained, 0);
    write_frame(0, frame_from(restrained, shared_sums, pair_islands[0].vertices));
    pair_islands[0].arrived = 0;
}

void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (collides_with_itself(self.cloth)) // the cloth of all threads
        add_to_cloth(self, gl_LocalInvocationID.x);
    if (FRAME_OF_ONE != 0 && push.cloths == 1)
        find_frame(gl_LocalInvocationID.x);
}
