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

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "constraints/limit_levels.glsl"
#include "constraints/limit_spring.glsl"

// The vertices of the finest of these levels, row by row. xs: positions, of this pass and of the next one; w is the
// relaxation. vs: velocities; w is the inverse mass of the vertex alone.
shared vec4 xs[2][VOILE_LIMIT_COARSE_VERTICES];
shared vec4 vs[VOILE_LIMIT_COARSE_VERTICES];

struct Grid
{
    uint cloth;
    ivec2 lines;
    int finest;      // spacing of the finest of these levels, in lines
    ivec2 own_lines; // of that level
};

Grid grid_of(PatchVertex self)
{
    Grid g;
    g.cloth = self.cloth;
    g.lines = ivec2(self.columns, self.rows);
    g.finest = 2 * int(cloths[self.cloth].strain_spacing);
    g.own_lines = (g.lines - 2 + g.finest) / g.finest + 1;
    return g;
}

ivec2 column_row(Grid g, uint k) { return min(g.finest * ivec2(k % g.own_lines.x, k / g.own_lines.x), g.lines - 1); }
// In the shared arrays.
uint slot(Grid g, ivec2 at)
{
    const ivec2 line = (at + g.finest - 1) / g.finest;
    return uint(line.y * g.own_lines.x + line.x);
}
uint vertex(Grid g, ivec2 at) { return cloths[g.cloth].first_vertex + uint(at.y * g.lines.x + at.x); }
uint vertex_count(Grid g) { return uint(g.own_lines.x * g.own_lines.y); }

void load(Grid g)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g); k += gl_WorkGroupSize.x)
    {
        const uint i = vertex(g, column_row(g, k));
        const vec4 x = positions[i];
        const vec4 v = velocities[i];
        xs[0][k] = vec4(x.xyz, k_safe_relaxation);
        vs[k] = vec4(v.xyz, limit_inverse_mass(x.w > 0 ? 1 : 0, v.w));
    }
}

void store(Grid g, uint now)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g); k += gl_WorkGroupSize.x)
    {
        const uint i = vertex(g, column_row(g, k));
        const FinePosition here = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
        const FinePosition next = moved(here, xs[now][k].xyz - here.x);
        next_positions[i] = vec4(next.x, positions[i].w);
        next_residuals[i] = pack_residual(next);
        next_velocities[i] = vec4(vs[k].xyz, 0);
    }
}

End end_at(uint k, uint now, float inverse_mass, bool is_first)
{
    const vec4 x = xs[now][k];
    const vec4 v = vs[k];
    return End(x.xyz, v.xyz, v.w * inverse_mass, is_first ? k_safe_relaxation : x.w);
}

Correction correction_of(Grid g, uint k, uint now, int spacing, bool is_first)
{
    Correction correction = k_no_correction;
    const ivec2 at = column_row(g, k);
    if (vs[k].w == 0 || !on_level(at, g.lines, spacing))
        return correction;
    const vec2 rest = vec2(cloths[g.cloth].springs[0].rest_length, cloths[g.cloth].springs[1].rest_length);
    const LevelNeighbors n = level_neighbors(at, g.lines, spacing, cloths[g.cloth].border_scale);
    const End end = end_at(k, now, inverse_mass_at(n, ivec2(0)), is_first);
    for (int s = 0; s < 8; ++s)
    {
        const ivec2 offset = level_offset(s);
        const ivec2 to = neighbor_at(n, at, offset);
        if (cloths[g.cloth].springs[level_class(s)].stiffness == 0 || to == at)
            continue;
        const End other = end_at(slot(g, to), now, inverse_mass_at(n, offset), is_first);
        add_limit(correction, end, other, (1 + cloths[g.cloth].strain_limit) * length(vec2(to - at) * rest), 0);
    }
    return correction;
}

// Vertices between the lines of the level before take the mean displacement of their neighbors there.
void interpolate(Grid g, uint now, int spacing)
{
    for (uint k = gl_LocalInvocationID.x; k < vertex_count(g); k += gl_WorkGroupSize.x)
    {
        const ivec2 at = column_row(g, k);
        if (vs[k].w == 0 || !on_level(at, g.lines, spacing) || on_level(at, g.lines, 2 * spacing))
            continue;
        const Between b = between_lines(at, g.lines, 2 * spacing);
        for (int corner = 0; corner < 4; ++corner)
        {
            const ivec2 to = corner_at(b, corner);
            const uint other = vertex(g, to);
            const float weight = corner_weight(b, corner);
            xs[now][k].xyz += weight * (xs[now][slot(g, to)].xyz - positions[other].xyz);
            vs[k].xyz += weight * (vs[slot(g, to)].xyz - velocities[other].xyz);
        }
    }
    barrier();
}

void pass(Grid g, uint now, int spacing, float acceleration, bool is_first)
{
    const uint k_owned = (VOILE_LIMIT_COARSE_VERTICES + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    vec3 v[k_owned];
    for (uint owned = 0; owned < k_owned; ++owned)
    {
        const uint k = owned * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        if (k >= vertex_count(g))
            break;
        const Correction correction = correction_of(g, k, now, spacing, is_first);
        const vec3 x = xs[now][k].xyz;
        const vec3 last = acceleration == 1 ? x : xs[1 - now][k].xyz;
        const float relaxation = stable_relaxation(correction.taken, cloths[g.cloth].strain_relaxation);
        xs[1 - now][k] = vec4(mix(last, x + correction.x, acceleration), relaxation);
        v[owned] = vs[k].xyz + correction.v;
    }
    barrier();
    for (uint owned = 0; owned < k_owned; ++owned)
    {
        const uint k = owned * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
        if (k < vertex_count(g))
            vs[k].xyz = v[owned];
    }
    barrier();
}

void limit(Grid g)
{
    load(g);
    barrier();
    uint now = 0;
    int spacing = g.finest;
    while (spacing < max(g.lines.x, g.lines.y) - 1)
        spacing *= 2;
    for (bool is_widest = true; spacing >= g.finest; spacing /= 2)
    {
        if (!is_widest)
            interpolate(g, now, spacing);
        is_widest = false;
        float acceleration = 1;
        for (uint i = 0; i < cloths[g.cloth].strain_passes; ++i)
        {
            acceleration = strain_acceleration(i, acceleration);
            pass(g, now, spacing, acceleration, i == 0);
            now = 1 - now;
        }
    }
    store(g, now);
}

void main()
{
    const uint patch_index = gl_WorkGroupID.x;
    const PatchVertex self = patch_vertex(patch_index);
    const bool limited = cloths[self.cloth].strain_limit > 0 && self.columns > 0;
    const Grid g = grid_of(self);
    if (self.exists && !(limited && on_level(self.column_row, g.lines, g.finest)))
    {
        next_positions[self.index] = positions[self.index];
        next_residuals[self.index] = residuals[self.index];
        next_velocities[self.index] = velocities[self.index];
    }
    const bool is_first = patch_index == 0 || patches[patch_index - 1].cloth != self.cloth;
    if (limited && is_first)
        limit(g);
}
