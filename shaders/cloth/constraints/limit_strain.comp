#version 460
#extension GL_GOOGLE_include_directive : require
// One pass of the strain limit, after a step's last substep. If a spring is longer than its limit, both ends move
// towards each other, each by its fraction of the masses. All springs are corrected at once (Jacobi). Corrections of
// both ends are opposite, so momentum is kept. The velocity that lengthens a spring at its limit is removed from both
// ends.
//
// A spring shorter than at rest is not shortened: it would store energy that nothing pays for. limit_work.comp measures
// the energy that the passes still add.
//
// A pass over neighbors carries a correction over one spring only. On a grid, passes therefore run from coarse to fine.
// A level moves only the vertices on its lines. After it the vertices between take the mean displacement of their
// neighbors (after Müller 2008, "Hierarchical position based dynamics"). The bound of the distance between far vertices
// follows from the bounds of the springs between them, so a level limits nothing that the springs would not. A coarse
// vertex has the mass of all that moves with it, which keeps momentum. limit_coarse.comp has taken the widest levels. On
// a mesh, and on a grid with pins between the lines of its levels, these are listed (limit_levels.cpp).
// One thread per vertex.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/strain_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(stage_positions)) readonly buffer StagePositions { vec4 positions[]; };
layout(VOILE_BINDING(stage_velocities)) readonly buffer StageVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(next_positions)) buffer NextPositions { vec4 next_positions[]; };
// w, except of the state: the relaxation of the vertex, from the pass before.
layout(VOILE_BINDING(next_velocities)) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(membrane_corners)) readonly buffer MembraneCorners { MembraneCorner membrane_corners[]; };
layout(VOILE_BINDING(limit_vertices)) readonly buffer LimitVertices { LimitVertex limit_vertices[]; };
layout(VOILE_BINDING(limit_levels)) readonly buffer LimitLevels { LimitLevel limit_levels[]; };
layout(VOILE_BINDING(limit_links)) readonly buffer LimitLinks { LimitLink limit_links[]; };
layout(VOILE_BINDING(limit_parents)) readonly buffer LimitParents { LimitParent limit_parents[]; };
layout(VOILE_BINDING(step_positions)) readonly buffer StepPositions { vec4 step_positions[]; };
layout(VOILE_BINDING(step_residuals)) readonly buffer StepResiduals { uvec2 step_residuals[]; };
layout(VOILE_BINDING(step_velocities)) readonly buffer StepVelocities { vec4 step_velocities[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(next_residuals)) buffer NextResiduals { uvec2 next_residuals[]; };

layout(push_constant, std430) uniform Push { StrainPush push; };

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "shared/mesh.glsl"
#include "constraints/limit_levels.glsl"
#include "constraints/limit_spring.glsl"

End end_at(uint index, float inverse_mass)
{
    const vec4 v = velocities[index];
    return End(positions[index].xyz, v.xyz, limit_inverse_mass(inverse_mass, step_velocities[index].w),
               push.pass == 0 ? k_safe_relaxation : v.w);
}

// m: a spring that is shorter than at rest may not become shorter than it was.
float shortest_length(uint self, uint other, float rest_length)
{
    return min(rest_length, distance(step_positions[self].xyz, step_positions[other].xyz));
}

#include "constraints/limit_triangles.glsl"

// All neighbors are loaded before the first is used. The vertex itself stands for one that is missing.
Correction limit_grid(PatchVertex self)
{
    const uint cloth = self.cloth;
    const ivec2 lines = ivec2(self.columns, self.rows);
    const ivec2 at = self.column_row;
    const int spacing = int(push.spacing);
    Correction correction = k_no_correction;
    if (!on_level(at, lines, spacing))
        return correction;
    const vec2 rest = vec2(cloths[cloth].springs[0].rest_length, cloths[cloth].springs[1].rest_length);
    const LevelNeighbors n = level_neighbors(at, lines, spacing, cloths[cloth].border_scale);
    End others[VOILE_LEVEL_NEIGHBORS];
    float lengths[VOILE_LEVEL_NEIGHBORS];
    float shortest[VOILE_LEVEL_NEIGHBORS];
    for (int k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
    {
        const ivec2 offset = level_offset(k);
        const bool has_spring = cloths[cloth].springs[level_class(k)].stiffness > 0;
        const ivec2 to = has_spring ? neighbor_at(n, at, offset) : at;
        const uint other = neighbor(self.index, to - at, self.columns);
        const float inverse_mass = positions[other].w;
        others[k] = end_at(other, spacing == 1 || inverse_mass == 0 ? inverse_mass : inverse_mass_at(n, offset));
        lengths[k] = length(vec2(to - at) * rest);
        shortest[k] = spacing == 1 ? shortest_length(self.index, other, lengths[k]) : 0;
    }
    const float inverse_mass = spacing == 1 ? positions[self.index].w : inverse_mass_at(n, ivec2(0));
    const End end = end_at(self.index, inverse_mass);
    for (int k = 0; k < VOILE_LEVEL_NEIGHBORS; ++k)
        add_limit(correction, end, others[k], (1 + level_limit(k, cloth)) * lengths[k],
                  shortest[k]);
    return correction;
}

// Of a vertex, by the passes so far. With residuals: far from the origin, rounded positions would lose momentum.
Correction change_of(uint i)
{
    const FinePosition start = FinePosition(step_positions[i].xyz, unpack_residual(step_residuals[i]));
    const FinePosition here = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    return Correction(displacement(start, here), velocities[i].xyz - step_velocities[i].xyz, k_no_correction.taken);
}

// The mean displacement and change of velocity of the neighbors on the lines of the level before.
Correction between(PatchVertex self)
{
    const ivec2 lines = ivec2(self.columns, self.rows);
    const int spacing = int(push.spacing);
    Correction sum = k_no_correction;
    if (!on_level(self.column_row, lines, spacing) || on_level(self.column_row, lines, 2 * spacing))
        return sum;
    const Between b = between_lines(self.column_row, lines, 2 * spacing);
    for (int corner = 0; corner < 4; ++corner)
    {
        const uint other = neighbor(self.index, corner_at(b, corner) - self.column_row, self.columns);
        const float weight = corner_weight(b, corner);
        const Correction change = change_of(other);
        sum.x += weight * change.x;
        sum.v += weight * change.v;
    }
    return sum;
}

LimitVertex limit_vertex(PatchVertex self) { return limit_vertices[cloths[self.cloth].first_limit + self.local]; }

// On a level that is listed.
Correction limit_listed(PatchVertex self)
{
    const uint cloth = self.cloth;
    const uint level = findLSB(push.spacing);
    const bool has_membrane = self.columns == 0 && (cloths[cloth].flags & VOILE_CLOTH_UNIFORM_SPRINGS) == 0;
    if (level == 0 && has_membrane)
        return limit_triangles(self);
    const LimitVertex vertex = limit_vertex(self);
    Correction correction = k_no_correction;
    if (level > vertex.top)
        return correction;
    const LimitLevel own = limit_levels[vertex.first_level + level];
    const End end = end_at(self.index, own.inverse_mass);
    const float limit = cloths[cloth].strain_limit;
    const float shear_limit = diagonal_limit(cloth);
    for (uint k = 0; k < own.links; ++k)
    {
        const LimitLink link = limit_links[own.first_link + k];
        const uint other_index = cloths[cloth].first_vertex + link.neighbor;
        const End other = end_at(other_index, positions[other_index].w > 0 ? link.inverse_mass : 0);
        add_limit(correction, end, other, (1 + mix(limit, shear_limit, link.shear)) * link.rest_length,
                  level == 0 ? shortest_length(self.index, other_index, link.rest_length) : 0);
    }
    return correction;
}

// The mean displacement and change of velocity of the parents, by their weights.
Correction between_listed(PatchVertex self)
{
    const LimitVertex vertex = limit_vertex(self);
    Correction sum = k_no_correction;
    if (vertex.top != findLSB(push.spacing))
        return sum;
    for (uint k = 0; k < vertex.parents; ++k)
    {
        const LimitParent parent = limit_parents[vertex.first_parent + k];
        const uint other = cloths[self.cloth].first_vertex + parent.vertex;
        const Correction change = change_of(other);
        sum.x += parent.weight * change.x;
        sum.v += parent.weight * change.v;
    }
    return sum;
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists || self.asleep)
        return;
    const uint i = self.index;
    const vec4 x = positions[i];
    const FinePosition here = FinePosition(x.xyz, unpack_residual(residuals[i]));
    // What other cloths need changes nothing: their wider levels and further passes leave this one alone.
    const bool own_pass = push.spacing <= cloths[self.cloth].strain_spacing && push.pass < cloths[self.cloth].strain_passes;
    const bool limited = cloths[self.cloth].strain_limit > 0 && x.w > 0 && own_pass;
    const bool listed = cloths[self.cloth].first_limit != VOILE_NO_LIMIT_LEVELS;
    Correction correction = k_no_correction;
    if (limited && push.between == 0)
        correction = listed ? limit_listed(self) : limit_grid(self);
    else if (limited)
        correction = listed ? between_listed(self) : between(self);
    vec3 shift = correction.x;
    if (limited && push.acceleration != 1) // this pass overwrites the result of the last but one
    {
        const vec3 last = next_positions[i].xyz;
        shift = mix(displacement(here, FinePosition(last, unpack_residual(next_residuals[i]))), shift, push.acceleration);
    }
    const FinePosition next = moved(here, shift);
    next_positions[i] = vec4(next.x, x.w);
    next_residuals[i] = pack_residual(next);
    const float w = push.last == 0 ? stable_relaxation(correction.taken, cloths[self.cloth].strain_relaxation)
                                   : uint(step_velocities[i].w) & ~VOILE_VERTEX_TOUCHES; // contact follows, and sets that
    next_velocities[i] = vec4(velocities[i].xyz + correction.v, w);
}
