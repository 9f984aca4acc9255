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
// A level moves only the vertices whose row and column are multiples of its spacing. After it the vertices between take
// the mean displacement of their neighbors (after Müller 2008, "Hierarchical position based dynamics"). The bound of
// the distance between far vertices follows from the bounds of the springs between them, so a level limits nothing that
// the springs would not. A coarse vertex has the mass of all that moves with it, which keeps momentum. A mesh compares
// the ends of its edges in every pass.
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
layout(VOILE_BINDING(mesh_springs)) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };

layout(VOILE_BINDING(step_positions)) readonly buffer StepPositions { vec4 step_positions[]; };
layout(VOILE_BINDING(step_velocities)) readonly buffer StepVelocities { vec4 step_velocities[]; };
layout(VOILE_BINDING(stage_residuals)) readonly buffer StageResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(next_residuals)) buffer NextResiduals { uvec2 next_residuals[]; };

layout(push_constant, std430) uniform Push { StrainPush push; };

#include "shared/patch.glsl"
#include "shared/fine_position.glsl"
#include "shared/grid.glsl"
#include "shared/mesh.glsl"
#include "forces/stiffness_sum.glsl"

struct Correction
{
    vec3 x;             // m
    vec3 v;             // m/s
    StiffnessSum taken; // of the springs beyond a bound: sum of fraction * (n n^T)
};

const Correction k_no_correction = Correction(vec3(0), vec3(0), StiffnessSum(vec3(0), vec3(0)));

// The end of a spring and its relaxation, the fraction of a correction that it takes. Both ends take the smaller one,
// so that momentum is kept. The inverse mass, 1/kg, is that of all that moves with the vertex on a coarse level.
struct End
{
    uint index;
    vec3 x; // m
    vec3 v; // m/s
    float inverse_mass;
    float relaxation;
};

// Safe for any vertex: up to eight springs in one line, each of which takes half.
const float k_safe_relaxation = 0.25;

End end_at(uint index, float inverse_mass)
{
    const vec4 v = velocities[index];
    return End(index, positions[index].xyz, v.xyz, inverse_mass, push.first == 1 ? k_safe_relaxation : v.w);
}

// m: the least length that the spring may be corrected to.
float shortest(End self, End other, float rest_length)
{
    return min(rest_length, distance(step_positions[self.index].xyz, step_positions[other.index].xyz));
}

// Springs beyond this fraction of their limit stop lengthening, too, or they would oscillate about it.
const float k_taut = 0.995;

// `rest_length`: m, of a spring between neighbors; 0: any shorter length is allowed.
void add_limit(inout Correction correction, End self, End other, float longest, float rest_length)
{
    const vec3 delta = other.x - self.x;
    const float distance = length(delta);
    const bool is_short = distance < rest_length;
    if (self.inverse_mass == 0 || distance == 0 || (!is_short && distance < k_taut * longest))
        return;
    const vec3 n = delta / distance;
    const float fraction = self.inverse_mass / (self.inverse_mass + other.inverse_mass);
    const float weight = min(self.relaxation, other.relaxation) * fraction;
    if (is_short)
    {
        const float missing = max(shortest(self, other, rest_length) - distance, 0);
        add_stiffness(correction.taken, missing > 0 ? fraction : 0, n, 1);
        correction.x -= weight * missing * n;
        return;
    }
    add_stiffness(correction.taken, fraction, n, 1);
    correction.x += weight * max(distance - longest, 0) * n;
    correction.v += weight * max(dot(other.v - self.v, n), 0) * n;
}

// The relaxation for which the passes converge, at most `relaxation`. Jacobi passes converge while the largest
// eigenvalue of the sum that a vertex takes is at most 1, as in a flat sheet. In crumpled cloth, whose springs fall
// into one line, it is up to twice that, and corrections would grow from pass to pass.
float stable_relaxation(StiffnessSum taken, float relaxation)
{
    const float squares = dot(taken.diagonal, taken.diagonal) + 2 * dot(taken.mixed, taken.mixed);
    if (relaxation * relaxation * squares <= 1) // the sum of the squared eigenvalues
        return relaxation;
    return min(relaxation, 1 / largest_eigenvalue(taken));
}

// The number of lines of a grid that move with a coarse line: the sum of the weights (1 - distance / spacing) of the
// lines around it, and of all lines beyond the last coarse one. Lines on the border count by their mass.
float lines_with(int line, int lines, int spacing, float border)
{
    const int last = (lines - 1) / spacing * spacing;
    const float beside = 0.5 * float(spacing - 1);
    const float before = line == 0 ? 0 : beside;
    const float after = line < last ? beside : line == lines - 1 ? 0 : float(lines - 2 - last) + border;
    const float self = line == 0 || line == lines - 1 ? border : 1;
    return before + self + after;
}

bool on_level(ivec2 column_row, int spacing) { return all(equal(column_row % spacing, ivec2(0))); }

float coarse_inverse_mass(uint cloth, ivec2 column_row, uint index, int spacing)
{
    const float inverse_mass = positions[index].w;
    if (spacing == 1 || inverse_mass == 0)
        return inverse_mass;
    const float border = cloths[cloth].border_scale;
    return 1 / (lines_with(column_row.x, int(cloths[cloth].columns), spacing, border) *
                lines_with(column_row.y, int(cloths[cloth].rows), spacing, border));
}

Correction limit_grid(PatchVertex self)
{
    const uint cloth = self.cloth;
    Correction correction = k_no_correction;
    const uint columns = cloths[cloth].columns;
    const int spacing = int(push.spacing);
    const ivec2 column_row = self.column_row;
    if (!on_level(column_row, spacing))
        return correction;
    const End end = end_at(self.index, coarse_inverse_mass(cloth, column_row, self.index, spacing));
    for (int c = 0; c < 4; ++c) // structural and shear
        for (int side = 0; side < 2; ++side)
        {
            const SpringClass spring = cloths[cloth].springs[c];
            const ivec2 offset = (side == 0 ? 1 : -1) * spacing * k_spring_offsets[c];
            if (spring.stiffness == 0 || !in_grid(column_row + offset, columns, cloths[cloth].rows))
                continue;
            const uint other = neighbor(self.index, offset, columns);
            add_limit(correction, end, end_at(other, coarse_inverse_mass(cloth, column_row + offset, other, spacing)),
                      (1 + cloths[cloth].strain_limit) * float(spacing) * spring.rest_length,
                      spacing == 1 ? spring.rest_length : 0);
        }
    return correction;
}

// The mean displacement and change of velocity of the neighbors on the lines of the level before.
Correction between(PatchVertex self)
{
    const uint cloth = self.cloth;
    Correction sum = k_no_correction;
    const int spacing = int(push.spacing);
    const ivec2 column_row = self.column_row;
    if (!on_level(column_row, spacing) || on_level(column_row, 2 * spacing))
        return sum;
    const ivec2 off = (column_row / spacing) % 2; // 1 where it lies between
    float count = 0;
    for (int corner = 0; corner < 4; ++corner)
    {
        const ivec2 side = ivec2(corner % 2, corner / 2);
        if (any(greaterThan(side, off)))
            continue; // not between: one neighbor, itself
        const ivec2 offset = spacing * off * (1 - 2 * side);
        if (!in_grid(column_row + offset, cloths[cloth].columns, cloths[cloth].rows))
            continue;
        const uint other = neighbor(self.index, offset, cloths[cloth].columns);
        sum.x += positions[other].xyz - step_positions[other].xyz;
        sum.v += velocities[other].xyz - step_velocities[other].xyz;
        count += 1;
    }
    sum.x /= count;
    sum.v /= count;
    return sum;
}

Correction limit_mesh(PatchVertex self, float inverse_mass)
{
    const uint cloth = self.cloth;
    Correction correction = k_no_correction;
    const End end = end_at(self.index, inverse_mass);
    const uint first = cloths[cloth].first_vertex;
    const MeshVertex vertex = mesh_vertices[cloths[cloth].first_list + self.local];
    for (uint s = 0; s < vertex.springs; ++s)
    {
        const MeshSpring entry = mesh_springs[vertex.first_spring + s * MESH_STRIDE];
        const uint other = first + (entry.neighbor & ~VOILE_OPPOSITE_BIT);
        if ((entry.neighbor & VOILE_OPPOSITE_BIT) == 0)
            add_limit(correction, end, end_at(other, positions[other].w),
                      (1 + cloths[cloth].strain_limit) * entry.rest_length, entry.rest_length);
    }
    return correction;
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const uint i = self.index;
    const vec4 x = positions[i];
    const FinePosition here = FinePosition(x.xyz, unpack_residual(residuals[i]));
    // What other cloths need changes nothing: their wider levels leave this one alone.
    const bool on_own_level = push.spacing << push.between <= cloths[self.cloth].strain_spacing;
    const bool limited = cloths[self.cloth].strain_limit > 0 && x.w > 0 && on_own_level;
    const bool grid = cloths[self.cloth].columns > 0;
    Correction correction = k_no_correction;
    if (limited && grid && push.between == 1)
        correction = between(self);
    else if (limited)
        correction = grid ? limit_grid(self) : limit_mesh(self, x.w);
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
