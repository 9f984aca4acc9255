#version 460
#extension GL_GOOGLE_include_directive : require
// The wide levels of the strain limit (limit_strain.comp), in one dispatch. They have few vertices, so that the workgroup
// of a cloth's first patch takes all of their passes in shared memory. The other workgroups copy the vertices that are on
// no such level.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(next_positions)) writeonly buffer NextPositions { vec4 next_positions[]; };
layout(VOILE_BINDING(next_velocities)) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(VOILE_BINDING(next_residuals)) writeonly buffer NextResiduals { uvec2 next_residuals[]; };
layout(VOILE_BINDING(limit_vertices)) readonly buffer LimitVertices { LimitVertex limit_vertices[]; };
layout(VOILE_BINDING(limit_levels)) readonly buffer LimitLevels { LimitLevel limit_levels[]; };
layout(VOILE_BINDING(limit_links)) readonly buffer LimitLinks { LimitLink limit_links[]; };
layout(VOILE_BINDING(limit_parents)) readonly buffer LimitParents { LimitParent limit_parents[]; };

#define VOILE_SHARES_LEVELS
#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "constraints/limit_levels.glsl"
#include "constraints/limit_spring.glsl"

// The vertices of the finest of these levels. Displacements of this pass and of the next one, whose w is the relaxation:
// sums of positions would lose momentum to rounding. The w of velocities is the inverse mass of the vertex alone.
shared vec4 displacements[2][VOILE_LIMIT_COARSE_VERTICES];
shared vec4 vs[VOILE_LIMIT_COARSE_VERTICES];
shared uint indices[VOILE_LIMIT_COARSE_VERTICES]; // in the solver's buffers

const uint k_no_slot = 0xffffffffu;

// The levels of a cloth: a vertex in the shared arrays is a slot.
struct Levels
{
    uint cloth;
    bool listed;
    int finest;
    int widest;
    uint slots;
    ivec2 lines;   // this and the following: of a grid
    int own_lines; // of the finest level, along a row
};

// The state at the start stays in its buffer: with it, the arrays would take more than the 16 KB that every device has.
End end_at(uint slot, uint now, float inverse_mass, bool is_first)
{
    const vec4 d = displacements[now][slot];
    const vec4 v = vs[slot];
    return End(positions[indices[slot]].xyz + d.xyz, v.xyz, v.w * inverse_mass, is_first ? k_safe_relaxation : d.w);
}

#include "constraints/limit_coarse_grid.glsl"
#include "constraints/limit_coarse_listed.glsl"

Levels levels_of(PatchVertex self)
{
    Levels levels;
    levels.cloth = self.cloth;
    levels.listed = cloths[self.cloth].first_limit != VOILE_NO_LIMIT_LEVELS;
    levels.finest = findLSB(cloths[self.cloth].strain_spacing) + 1;
    levels.lines = ivec2(self.columns, self.rows);
    if (levels.listed)
        find_listed(levels);
    else
        find_lines(levels);
    return levels;
}

// The slot of the k-th vertex of a level, or k_no_slot.
uint slot_at(Levels levels, int level, uint k) { return levels.listed ? listed_slot_at(levels, level, k) : grid_slot_at(levels, level, k); }

void load(Levels levels)
{
    for (uint k = gl_LocalInvocationID.x; k < levels.slots; k += gl_WorkGroupSize.x)
    {
        const uint slot = slot_at(levels, levels.finest, k);
        if (slot == k_no_slot)
            break;
        const uint i = levels.listed ? listed_index(levels, slot) : grid_index(levels, slot);
        const vec4 v = velocities[i];
        indices[slot] = i;
        displacements[0][slot] = displacements[1][slot] = vec4(vec3(0), cloths[levels.cloth].strain_relaxation);
        vs[slot] = vec4(v.xyz, limit_inverse_mass(positions[i].w > 0 ? 1 : 0, v.w));
    }
}

void store(Levels levels, uint now)
{
    for (uint k = gl_LocalInvocationID.x; k < levels.slots; k += gl_WorkGroupSize.x)
    {
        const uint slot = slot_at(levels, levels.finest, k);
        if (slot == k_no_slot)
            break;
        const uint i = indices[slot];
        const FinePosition here = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
        const FinePosition next = moved(here, displacements[now][slot].xyz);
        next_positions[i] = vec4(next.x, positions[i].w);
        next_residuals[i] = pack_residual(next);
        next_velocities[i] = vec4(vs[slot].xyz, 0);
    }
}

// Vertices between those of the level before take the mean displacement of their neighbors there.
void interpolate(Levels levels, uint now, int level)
{
    for (uint k = gl_LocalInvocationID.x; k < levels.slots; k += gl_WorkGroupSize.x)
    {
        const uint slot = slot_at(levels, level, k);
        if (slot == k_no_slot)
            break;
        const bool is_between = levels.listed ? listed_top(levels, slot) == level : is_between_lines(levels, k, level);
        if (!is_between || vs[slot].w == 0)
            continue;
        const Correction mean =
            levels.listed ? listed_between(levels, slot, now) : grid_between(levels, k, uvec2(now, level));
        displacements[now][slot].xyz = mean.x;
        vs[slot].xyz += mean.v;
    }
    barrier();
}

void pass(Levels levels, uint now, int level, float acceleration, int pass_index)
{
    const uint k_owned = (VOILE_LIMIT_COARSE_VERTICES + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    vec3 v[k_owned];
    uint slots[k_owned];
    for (uint owned = 0; owned < k_owned; ++owned)
    {
        const uint k = owned * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        const uint slot = k < levels.slots ? slot_at(levels, level, k) : k_no_slot;
        slots[owned] = slot;
        if (slot == k_no_slot)
            continue;
        v[owned] = vs[slot].xyz;
        if (vs[slot].w == 0)
            continue; // pinned: it has no displacement
        const uvec3 at = uvec3(now, level, pass_index);
        const Correction correction =
            levels.listed ? listed_correction(levels, slot, at) : grid_correction(levels, k, at);
        const vec3 d = displacements[now][slot].xyz + correction.x;
        const float relaxation = stable_relaxation(correction.taken, cloths[levels.cloth].strain_relaxation);
        const vec3 last = displacements[1 - now][slot].xyz;
        displacements[1 - now][slot] = vec4(acceleration == 1 ? d : mix(last, d, acceleration), relaxation);
        v[owned] += correction.v;
    }
    barrier();
    for (uint owned = 0; owned < k_owned; ++owned)
        if (slots[owned] != k_no_slot)
            vs[slots[owned]].xyz = v[owned];
    barrier();
}

void limit(Levels levels)
{
    load(levels);
    barrier();
    uint now = 0;
    for (int level = levels.widest; level >= levels.finest; --level)
    {
        if (level < levels.widest)
            interpolate(levels, now, level);
        float acceleration = 1;
        for (uint i = 0; i < cloths[levels.cloth].strain_passes; ++i)
        {
            acceleration = strain_acceleration(i, acceleration);
            pass(levels, now, level, acceleration, int(i));
            now = 1 - now;
        }
    }
    store(levels, now);
}

void main()
{
    const uint patch_index = gl_WorkGroupID.x;
    const PatchVertex self = patch_vertex(patch_index);
    if (self.asleep)
        return;
    const Levels levels = levels_of(self);
    const bool limited = cloths[self.cloth].strain_limit > 0 && levels.widest >= levels.finest;
    const bool is_on = levels.listed ? limit_vertices[cloths[self.cloth].first_limit + self.local].top >= levels.finest
                                     : on_level(self.column_row, levels.lines, 1 << levels.finest);
    if (self.exists && gl_LocalInvocationID.x < PATCH_SIZE && !(limited && is_on))
    {
        next_positions[self.index] = positions[self.index];
        next_residuals[self.index] = residuals[self.index];
        next_velocities[self.index] = velocities[self.index];
    }
    const bool is_first = patch_index == 0 || patches[patch_index - 1].cloth != self.cloth;
    if (limited && is_first)
        limit(levels);
}
