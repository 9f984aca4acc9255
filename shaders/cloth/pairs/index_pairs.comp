#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Makes the lists of pairs (find_pairs.comp, match_pairs.comp) ready for passes: which pairs each vertex is in, how far
// it may leave its sweep before pairs that no list has could meet, the thickness of each pair, and the dispatches of a
// pass. One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_owners)) readonly buffer MeshOwners { uint mesh_owners[]; };
layout(VOILE_BINDING(start)) readonly buffer Start { vec4 start[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(pairs)) readonly buffer Pairs { uvec4 pairs[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_lists)) readonly buffer PairLists { PairList pair_lists[]; };
layout(VOILE_BINDING(pair_thicknesses)) writeonly buffer PairThicknesses { float pair_thicknesses[]; };
layout(VOILE_BINDING(pair_masks)) buffer PairMasks { uint pair_masks[]; };
layout(VOILE_BINDING(pair_entries)) writeonly buffer PairEntries { uint pair_entries[]; };
layout(VOILE_BINDING(paired_vertices)) writeonly buffer PairedVertices { uvec4 paired_vertices[]; };
layout(VOILE_BINDING(pair_references)) writeonly buffer PairReferences { uint pair_references[]; };
layout(VOILE_BINDING(pair_islands)) buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(push_constant, std430) uniform Push { PairPush push; };

#include "shared/patch.glsl"
#include "pairs/isolated.glsl"
#include "pairs/mean_velocity.glsl"
#include "pairs/owners.glsl"
#include "pairs/pair.glsl"
#include "pairs/pair_masks.glsl"
#include "pairs/pair_pass.glsl"
#include "pairs/pair_tree.glsl"
#include "pairs/sweep.glsl"

// The part of the thickness that no pair comes closer than while no list has it. Else full lists would let it come
// closer with each search, until rounding hides which side is which.
const float k_unlisted_floor = 0.02;
// A list is crowded from this part of its capacity on.
const float k_crowded_part = 0.75;
const float k_unbounded = 1e18; // m; its square is a number

// Of the pairs of an owner, those that a vertex is in on the owner's side.
uint pairs_around(uint vertex, uint owner, uint mask)
{
    uint result = 0;
    for (; mask != 0; mask &= mask - 1)
    {
        const uint e = findLSB(mask);
        const Pair pair = unpacked(pairs[owner * VOILE_PAIRS + e]);
        const uint place = place_in(pair, vertex);
        const bool first = owners_of(pair).x == owner;
        if (place != 4 && (place < first_side(pair)) == first)
            result |= 1u << e;
    }
    return result;
}

// m, at which the primitives of a pair repel each other. Those of one cloth that are nearer at rest do from half of
// their distance there on.
float thickness_of(Pair pair)
{
    const uvec2 owners = owners_of(pair);
    const uvec2 of = uvec2(pair_lists[owners.x].cloth, pair_lists[owners.y].cloth);
    const float thickness = 0.5 * (cloths[of.x].pair_thickness + cloths[of.y].pair_thickness);
    if (of.x != of.y)
        return thickness;
    vec3 x[4];
    [[unroll]] for (uint k = 0; k < 4; ++k)
        x[k] = start[pair.vertices[k]].xyz;
    return min(thickness, 0.5 * length(nearest_points(pair.edges, x).apart));
}

// What a workgroup adds to the dispatches of a pass, and where: its first pair, vertex and reference.
shared uint shared_pairs;
shared uint shared_vertices;
shared uint shared_references;

// Only vertices that have found pairs were matched.
uint mask_of(PairList list) { return list.count == 0 ? 0 : list.mask; }

bool is_crowded(PairList list) { return float(list.count) >= k_crowded_part * float(push.capacity); }

uint groups_of(uint threads) { return (threads + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x; }

void reserve()
{
    const uint pairs_end = shared_pairs;
    const uint vertices_end = shared_vertices;
    shared_pairs = pairs_end == 0 ? 0 : atomicAdd(pair_passes[VOILE_PAIR_MEET].entries, pairs_end);
    shared_vertices = vertices_end == 0 ? 0 : atomicAdd(pair_passes[VOILE_PAIR_RESPOND].entries, vertices_end);
    shared_references =
        shared_references == 0 ? 0 : atomicAdd(pair_passes[VOILE_PAIR_REFERENCES].entries, shared_references);
    atomicMax(pair_passes[VOILE_PAIR_MEET].groups, groups_of(shared_pairs + pairs_end));
    atomicMax(pair_passes[VOILE_PAIR_RESPOND].groups, groups_of((shared_vertices + vertices_end) * push.threads));
}

void publish(uint vertex, uint mask, uint at)
{
    for (; mask != 0; mask &= mask - 1)
    {
        const uint entry = vertex * VOILE_PAIRS + findLSB(mask);
        pair_thicknesses[entry] = thickness_of(unpacked(pairs[entry]));
        pair_entries[at++] = entry;
    }
}

// The order is that of the lists, wherever they are.
void refer(Fan fan, uint at)
{
    for (uint k = 0; k < owner_count(fan); ++k)
    {
        uint owner;
        if (owner_of(fan, k, owner))
            for (uint mask = pair_masks[mask_place(fan, k, push.vertices)]; mask != 0; mask &= mask - 1)
                pair_references[at++] = owner * VOILE_PAIRS + findLSB(mask);
    }
}

// Until a pass finds the vertex in a pair, only its sweep bounds it. Where even sweeps come too near each other, the
// vertex stays on its carry. All that falls freely has the same. Else the clock stops, and the vertex stays where it is.
// The next sweeps are shorter, because it loses its velocity or, if a collider pushes it, by halvings.glsl.
void bound(uint i, uint cloth, float reach, uint listed)
{
    PairSweep sweep;
    sweep.from = positions[i].xyz;
    sweep.reach = max(VOILE_PAIR_APPROACH * reach, 0);
    sweep.sweep = reach > 0 ? 2 * unpack_half_sweep(floatBitsToUint(midpoints[i].w)) : vec3(0);
    sweep.listed = listed;
    sweep.carry = pair_carries[i];
    sweep.fall = falls(sweep.carry) * ((cloths[cloth].flags & VOILE_CLOTH_VERLET) != 0 ? 0.5 : 1);
    if (reach <= 0 && sweep.fall == 0)
        pair_islands[island_of(cloth)].stopped = pair_pass() + 1;
    sweep.residual = residuals[i];
    pair_bounds[i].sweep = sweep;
    pair_bounds[i].impulse = vec3(0);
    const bool driven = positions[i].w == 0 || (uint(velocities[i].w) & VOILE_VERTEX_PUSHED) != 0;
    const vec3 frame = velocity_at(frame_of(cloth), sweep.from, 0);
    if (driven && sweep.reach < pair_interval() * distance(velocities[i].xyz, frame))
        pair_searches[VOILE_PAIR_CROWDED].entries = pair_pass() + 1;
}

// The clock of a cloth begins.
void begin_clock(uint cloth)
{
    const uint parity = pair_pass() & 1u;
    pair_islands[cloth].rates[parity] = floatBitsToUint(1);
    pair_islands[cloth].clocks[parity] = pair_islands[cloth].falls[parity] = pair_islands[cloth].times[parity] = 0;
    const vec3 mean = mean_velocity(island_of(cloth));
    const uint word = pack_carry(mean);
    const vec3 packed = carry_velocity(word);
    for (uint k = 0; k < 3; ++k)
        pair_islands[cloth].rounded_off[k] = mean[k] - packed[k];
}

// The pairs that the vertex is in, as masks. The first of them has all pairs of its own list.
void main()
{
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    const uint i = self.index;
    if (gl_GlobalInvocationID.x < VOILE_PAIR_SEARCHES)
        pair_searches[gl_GlobalInvocationID.x].wanted = 0;
    for (uint c = gl_LocalInvocationID.x; gl_WorkGroupID.x == 0 && c < push.cloths; c += gl_WorkGroupSize.x)
        begin_clock(c);
    if (gl_GlobalInvocationID.x == 0)
    {
        if (push.pass == 0)
            pair_searches[VOILE_PAIR_UNTANGLED].entries =
                pair_searches[VOILE_PAIR_TANGLED].entries == 0 ? pair_searches[VOILE_PAIR_UNTANGLED].entries + 1 : 0;
        pair_searches[VOILE_PAIR_URGENCY].entries = 0;
        ++pair_searches[VOILE_PAIR_SEARCHED].entries;
        pair_passes[VOILE_PAIR_FIND] = pair_passes[VOILE_PAIR_SIFT] = PairDispatch(0, 1, 1, 0);
    }
    if (gl_LocalInvocationID.x == 0)
        shared_pairs = shared_vertices = shared_references = 0;
    uint own = 0;
    uint references = 0;
    Fan fan;
    if (self.exists && collides_with_itself(self.cloth))
    {
        fan = fan_of(self.cloth, i);
        float reach = pair_lists[i].range;
        own = mask_of(pair_lists[i]);
        bool crowded = false;
        for (uint k = 0; k < owner_count(fan); ++k)
        {
            uint owner;
            uint mask = 0;
            if (owner_of(fan, k, owner))
            {
                const PairList list = pair_lists[owner];
                reach = min(reach, list.range);
                crowded = crowded || is_crowded(list);
                mask = k == 0 ? own : pairs_around(i, owner, mask_of(list));
            }
            pair_masks[mask_place(fan, k, push.vertices)] = mask;
            references += bitCount(mask);
        }
        if (is_isolated(self))
            reach = k_unbounded; // nothing hangs on a vertex without triangles
        const uint listed = references == 0 ? 0 : crowded ? VOILE_PAIR_CROWDED_LIST : 1;
        bound(i, self.cloth, reach - k_unlisted_floor * cloths[self.cloth].pair_thickness, listed);
    }
    barrier();
    uint pair_place = atomicAdd(shared_pairs, bitCount(own));
    uint vertex_place = atomicAdd(shared_vertices, references != 0 ? 1 : 0);
    const uint first = atomicAdd(shared_references, references);
    barrier();
    if (gl_LocalInvocationID.x == 0)
        reserve();
    barrier();
    publish(i, own, shared_pairs + pair_place);
    if (references == 0)
        return;
    refer(fan, shared_references + first);
    paired_vertices[shared_vertices + vertex_place] = uvec4(i, self.cloth, shared_references + first, references);
}
