#version 460
#extension GL_GOOGLE_include_directive : require
// The wide levels of the strain limit on a grid (limit_strain.comp), in one dispatch. They have few vertices, so that
// the workgroup of a cloth's first patch takes all of their passes in shared memory. The other workgroups copy the
// vertices that are on no such level.
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

#define VOILE_SHARES_LEVELS
#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "constraints/limit_levels.glsl"
#include "constraints/limit_spring.glsl"

// The vertices of the finest of these levels, row by row. Displacements of this pass and of the next one, whose w is the
// relaxation: sums of positions would lose momentum to rounding. The w of velocities is the inverse mass of the vertex
// alone.
shared vec4 displacements[2][VOILE_LIMIT_COARSE_VERTICES];
shared vec4 vs[VOILE_LIMIT_COARSE_VERTICES];

struct Grid
{
    uint cloth;
    ivec2 lines;
    int shift;     // the spacing of the finest of these levels is 1 << shift lines
    int own_lines; // of that level, along a row
};

// Of the level, along each axis.
ivec2 line_counts(Grid g, int shift) { return ((g.lines - 2 + (1 << shift)) >> shift) + 1; }

Grid grid_of(PatchVertex self)
{
    Grid g;
    g.cloth = self.cloth;
    g.lines = ivec2(self.columns, self.rows);
    g.shift = findLSB(cloths[self.cloth].strain_spacing) + 1;
    g.own_lines = line_counts(g, g.shift).x;
    return g;
}

uint vertex_count(Grid g, int shift)
{
    const ivec2 counts = line_counts(g, shift);
    return uint(counts.x * counts.y);
}

// The k-th vertex of a level.
ivec2 column_row(Grid g, int shift, uint k)
{
    const uint columns = uint(line_counts(g, shift).x);
    return min(ivec2(k % columns, k / columns) << shift, g.lines - 1);
}

// In the shared arrays.
uint slot(Grid g, ivec2 at)
{
    const ivec2 line = (at + (1 << g.shift) - 1) >> g.shift;
    return uint(line.y * g.own_lines + line.x);
}

uint vertex(Grid g, ivec2 at) { return cloths[g.cloth].first_vertex + uint(at.y * g.lines.x + at.x); }

void load(Grid g)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g, g.shift); k += gl_WorkGroupSize.x)
    {
        const uint i = vertex(g, column_row(g, g.shift, k));
        const vec4 v = velocities[i];
        displacements[0][k] = displacements[1][k] = vec4(vec3(0), cloths[g.cloth].strain_relaxation);
        vs[k] = vec4(v.xyz, limit_inverse_mass(positions[i].w > 0 ? 1 : 0, v.w));
    }
}

void store(Grid g, uint now)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g, g.shift); k += gl_WorkGroupSize.x)
    {
        const uint i = vertex(g, column_row(g, g.shift, k));
        const FinePosition here = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
        const FinePosition next = moved(here, displacements[now][k].xyz);
        next_positions[i] = vec4(next.x, positions[i].w);
        next_residuals[i] = pack_residual(next);
        next_velocities[i] = vec4(vs[k].xyz, 0);
    }
}

// The state at the start stays in its buffer: with it, the arrays would take more than the 16 KB that every device has.
End end_at(Grid g, ivec2 at, uint now, float inverse_mass, bool is_first)
{
    const uint k = slot(g, at);
    const vec4 d = displacements[now][k];
    const vec4 v = vs[k];
    return End(positions[vertex(g, at)].xyz + d.xyz, v.xyz, v.w * inverse_mass, is_first ? k_safe_relaxation : d.w);
}

Correction correction_of(Grid g, ivec2 at, uint now, ivec2 spacing_and_pass)
{
    const int spacing = spacing_and_pass.x;
    const bool is_first = spacing_and_pass.y == 0;
    const vec2 rest = vec2(cloths[g.cloth].springs[0].rest_length, cloths[g.cloth].springs[1].rest_length);
    const LevelNeighbors n = level_neighbors(at, g.lines, spacing, cloths[g.cloth].border_scale);
    End others[8]; // all are loaded before the first is used
    float longest[8];
    for (int s = 0; s < 8; ++s)
    {
        const ivec2 offset = level_offset(s);
        const bool has_spring = cloths[g.cloth].springs[level_class(s)].stiffness > 0;
        const ivec2 to = has_spring ? neighbor_at(n, at, offset) : at; // the vertex itself stands for one that is missing
        others[s] = end_at(g, to, now, inverse_mass_at(n, offset), is_first);
        longest[s] = (1 + level_limit(s, g.cloth)) * length(vec2(to - at) * rest);
    }
    const End end = end_at(g, at, now, inverse_mass_at(n, ivec2(0)), is_first);
    Correction correction = k_no_correction;
    for (int s = 0; s < 8; ++s)
        add_limit(correction, end, others[s], longest[s], 0);
    return correction;
}

// Vertices between the lines of the level before take the mean displacement of their neighbors there.
void interpolate(Grid g, uint now, int shift)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g, shift); k += gl_WorkGroupSize.x)
    {
        const ivec2 at = column_row(g, shift, k);
        const uint self = slot(g, at);
        if (vs[self].w == 0 || on_level(at, g.lines, 2 << shift))
            continue;
        const Between b = between_lines(at, g.lines, 2 << shift);
        vec3 displacement = vec3(0);
        for (int corner = 0; corner < 4; ++corner)
        {
            const ivec2 to = corner_at(b, corner);
            const float weight = corner_weight(b, corner);
            displacement += weight * displacements[now][slot(g, to)].xyz;
            vs[self].xyz += weight * (vs[slot(g, to)].xyz - velocities[vertex(g, to)].xyz);
        }
        displacements[now][self].xyz = displacement;
    }
    barrier();
}

void pass(Grid g, uint now, int shift, float acceleration, int pass_index)
{
    const uint k_owned = (VOILE_LIMIT_COARSE_VERTICES + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    vec3 v[k_owned];
    for (uint owned = 0; owned < k_owned; ++owned)
    {
        const uint k = owned * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        if (k >= vertex_count(g, shift))
            break;
        const ivec2 at = column_row(g, shift, k);
        const uint self = slot(g, at);
        v[owned] = vs[self].xyz;
        if (vs[self].w == 0)
            continue; // pinned: it has no displacement
        const Correction correction = correction_of(g, at, now, ivec2(1 << shift, pass_index));
        const vec3 d = displacements[now][self].xyz + correction.x;
        const float relaxation = stable_relaxation(correction.taken, cloths[g.cloth].strain_relaxation);
        const vec3 last = displacements[1 - now][self].xyz;
        displacements[1 - now][self] = vec4(acceleration == 1 ? d : mix(last, d, acceleration), relaxation);
        v[owned] += correction.v;
    }
    barrier();
    for (uint owned = 0; owned < k_owned; ++owned)
    {
        const uint k = owned * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        if (k < vertex_count(g, shift))
            vs[slot(g, column_row(g, shift, k))].xyz = v[owned];
    }
    barrier();
}

void limit(Grid g)
{
    load(g);
    barrier();
    uint now = 0;
    int widest = g.shift;
    while (1 << widest < max(g.lines.x, g.lines.y) - 1)
        ++widest;
    for (int shift = widest; shift >= g.shift; --shift)
    {
        if (shift < widest)
            interpolate(g, now, shift);
        float acceleration = 1;
        for (uint i = 0; i < cloths[g.cloth].strain_passes; ++i)
        {
            acceleration = strain_acceleration(i, acceleration);
            pass(g, now, shift, acceleration, int(i));
            now = 1 - now;
        }
    }
    store(g, now);
}

void main()
{
    const uint patch_index = gl_WorkGroupID.x;
    PatchVertex self = patch_vertex(patch_index);
    if (self.asleep)
        return;
    self.exists = self.exists && gl_LocalInvocationID.x < PATCH_SIZE;
    const bool limited =
        cloths[self.cloth].strain_limit > 0 && cloths[self.cloth].first_limit == VOILE_NO_LIMIT_LEVELS;
    const Grid g = grid_of(self);
    if (self.exists && !(limited && on_level(self.column_row, g.lines, 1 << g.shift)))
    {
        next_positions[self.index] = positions[self.index];
        next_residuals[self.index] = residuals[self.index];
        next_velocities[self.index] = velocities[self.index];
    }
    const bool is_first = patch_index == 0 || patches[patch_index - 1].cloth != self.cloth;
    if (limited && is_first)
        limit(g);
}
