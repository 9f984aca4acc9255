#version 460
#extension GL_GOOGLE_include_directive : require
// One pass of the strain limit, after a step's last substep: where a spring is longer than its limit, both ends are moved
// towards each other, each by its share of the masses, and the velocity that lengthens it on is taken from both alike. All
// springs at once (Jacobi): what one end gets the other gets in return, so that momentum is kept, save where cloth is so
// crumpled that a vertex bears less than its share.
//
// A pass over neighbours carries a correction one spring far. On a grid, passes therefore go from coarse to fine: a level
// moves only the vertices whose row and column are multiples of its spacing, and after it the vertices between take the mean
// of what their neighbours were moved by (after Müller 2008, "Hierarchical position based dynamics"). A bound for the way
// between far vertices follows from those for the springs between them, so that nothing is limited that the limit would not.
// A coarse vertex has the mass of what moves with it, which keeps the momentum of the whole. A mesh compares the ends of its
// edges in every pass.
// A thread moves one vertex. Reads: cloths, chunks, mesh lists, places at the step's end, state before. Writes: state after.
#include "cloth_layout.h"

layout(local_size_x_id = 0) in;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) readonly buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 4, std430) buffer NextPositions { vec4 next_positions[]; };
layout(set = 0, binding = 5, std430) writeonly buffer NextVelocities { vec4 next_velocities[]; };
layout(set = 0, binding = 6, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 7, std430) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };

layout(set = 0, binding = 8, std430) readonly buffer StepPositions { vec4 step_positions[]; };
layout(set = 0, binding = 9, std430) readonly buffer StepVelocities { vec4 step_velocities[]; };
layout(set = 0, binding = 10, std430) readonly buffer Residuals { uvec2 residuals[]; };
layout(set = 0, binding = 11, std430) buffer NextResiduals { uvec2 next_residuals[]; };

layout(push_constant, std430) uniform Push { StrainPush push; };

#include "chunk.glsl"
#include "fine_position.glsl"
#include "grid.glsl"
#include "mesh.glsl"
#include "stiffness_sum.glsl"

struct Correction
{
    vec3 x; // m
    vec3 v; // m/s
    StiffnessSum taken; // of the springs at their limit: sum of share * (n n^T)
};

const StiffnessSum k_nothing = StiffnessSum(vec3(0), vec3(0));

// Springs this near below their limit have their lengthening stopped too, or they would swing about it.
const float k_taut = 0.995;

// `own`, `theirs`: inverse masses, or what stands for them on a coarse level.
void add_limit(inout Correction correction, vec3 x, vec3 v, float own, uint other, float theirs, float longest)
{
    const vec3 delta = positions[other].xyz - x;
    const float distance = length(delta);
    if (distance < k_taut * longest || own == 0)
        return;
    const vec3 n = delta / distance;
    const float share = own / (own + theirs);
    add_stiffness(correction.taken, share, n, 1);
    correction.x += share * max(distance - longest, 0) * n;
    correction.v += share * max(dot(velocities[other].xyz - v, n), 0) * n;
}

// What of `relaxation` is borne. All springs at once converge while twice the largest eigenvalue of what a vertex takes is
// at most 2, as it is in a flat sheet. In crumpled cloth, whose springs fall into one line, it is up to twice that, and
// corrections would grow from pass to pass.
float borne(StiffnessSum taken, float relaxation)
{
    const float squares = dot(taken.diagonal, taken.diagonal) + 2 * dot(taken.mixed, taken.mixed);
    if (relaxation * relaxation * squares <= 1) // the sum of the squared eigenvalues
        return relaxation;
    return min(relaxation, 1 / largest_eigenvalue(taken));
}

// How many lines of a grid move with a coarse line: the sum of the weights (1 - distance / spacing) of the lines around it,
// and of all lines beyond the last coarse one; lines on the border count as their share of the mass.
float lines_with(int line, int lines, int spacing, float border_share)
{
    const int last = (lines - 1) / spacing * spacing;
    const float beside = 0.5 * float(spacing - 1);
    const float before = line == 0 ? 0 : beside;
    const float after = line < last ? beside : line == lines - 1 ? 0 : float(lines - 2 - last) + border_share;
    const float self = line == 0 || line == lines - 1 ? border_share : 1;
    return before + self + after;
}

bool on_level(ivec2 place, int spacing) { return all(equal(place % spacing, ivec2(0))); }

float coarse_inverse_mass(uint cloth, ivec2 place, uint index, int spacing)
{
    const float inverse_mass = positions[index].w;
    if (spacing == 1 || inverse_mass == 0)
        return inverse_mass;
    const float share = cloths[cloth].border_share;
    return 1 / (lines_with(place.x, int(cloths[cloth].columns), spacing, share) *
                lines_with(place.y, int(cloths[cloth].rows), spacing, share));
}

Correction limit_grid(ChunkVertex self, vec3 x, vec3 v)
{
    const uint cloth = self.cloth;
    Correction correction = Correction(vec3(0), vec3(0), k_nothing);
    const uint columns = cloths[cloth].columns;
    const int spacing = int(push.spacing);
    const ivec2 place = self.place;
    if (!on_level(place, spacing))
        return correction;
    const float own = coarse_inverse_mass(cloth, place, self.index, spacing);
    for (int c = 0; c < 4; ++c) // structural and shear
        for (int side = 0; side < 2; ++side)
        {
            const SpringClass spring = cloths[cloth].springs[c];
            const ivec2 offset = (side == 0 ? 1 : -1) * spacing * k_spring_offsets[c];
            if (spring.stiffness == 0 || !in_grid(place + offset, columns, cloths[cloth].rows))
                continue;
            const uint other = neighbour(self.index, offset, columns);
            add_limit(correction, x, v, own, other, coarse_inverse_mass(cloth, place + offset, other, spacing),
                      (1 + cloths[cloth].strain_limit) * float(spacing) * spring.rest_length);
        }
    return correction;
}

// What a vertex between the lines of the level before takes over from its neighbours on them.
Correction between(ChunkVertex self)
{
    const uint cloth = self.cloth;
    Correction sum = Correction(vec3(0), vec3(0), k_nothing);
    const int spacing = int(push.spacing);
    const ivec2 place = self.place;
    if (!on_level(place, spacing) || on_level(place, 2 * spacing))
        return sum;
    const ivec2 off = (place / spacing) % 2; // 1 where it lies between
    float count = 0;
    for (int corner = 0; corner < 4; ++corner)
    {
        const ivec2 side = ivec2(corner % 2, corner / 2);
        if (any(greaterThan(side, off)))
            continue; // not between: one neighbour, itself
        const ivec2 offset = spacing * off * (1 - 2 * side);
        if (!in_grid(place + offset, cloths[cloth].columns, cloths[cloth].rows))
            continue;
        const uint other = neighbour(self.index, offset, cloths[cloth].columns);
        sum.x += positions[other].xyz - step_positions[other].xyz;
        sum.v += velocities[other].xyz - step_velocities[other].xyz;
        count += 1;
    }
    return Correction(sum.x / count, sum.v / count, k_nothing);
}

Correction limit_mesh(uint cloth, uint local, vec3 x, vec3 v, float inverse_mass)
{
    Correction correction = Correction(vec3(0), vec3(0), k_nothing);
    const uint first = cloths[cloth].first_vertex;
    const MeshVertex vertex = mesh_vertices[cloths[cloth].first_list + local];
    for (uint s = 0; s < vertex.springs; ++s)
    {
        const MeshSpring entry = mesh_springs[vertex.first_spring + s * MESH_STRIDE];
        const uint other = first + (entry.neighbour & ~VOILE_OPPOSITE_BIT);
        if ((entry.neighbour & VOILE_OPPOSITE_BIT) == 0)
            add_limit(correction, x, v, inverse_mass, other, positions[other].w,
                      (1 + cloths[cloth].strain_limit) * entry.rest_length);
    }
    return correction;
}

void main()
{
    const ChunkVertex self = chunk_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const uint cloth = self.cloth;
    const uint i = self.index;
    const vec4 x = positions[i];
    const vec4 v = velocities[i];
    const bool grid = cloths[cloth].columns > 0;
    Correction correction = Correction(vec3(0), vec3(0), k_nothing);
    const bool limited = cloths[cloth].strain_limit > 0 && x.w > 0;
    if (limited)
    {
        float relaxation = cloths[cloth].strain_relaxation;
        if (!grid)
            correction = limit_mesh(cloth, self.local, x.xyz, v.xyz, x.w);
        else if (push.between == 1)
        {
            correction = between(self);
            relaxation = 1;
        }
        else
            correction =
                limit_grid(self, x.xyz, v.xyz);
        relaxation = borne(correction.taken, relaxation);
        correction.x *= relaxation;
        correction.v *= relaxation;
    }
    const FinePosition here = FinePosition(x.xyz, unpack_residual(residuals[i]));
    if (limited && push.acceleration != 1) // what this pass overwrites is the result of the last but one
    {
        const vec3 last = next_positions[i].xyz;
        correction.x = mix(displacement(here, FinePosition(last, unpack_residual(next_residuals[i]))), correction.x,
                           push.acceleration);
    }
    const FinePosition next = moved(here, correction.x);
    next_positions[i] = vec4(next.x, x.w);
    next_residuals[i] = pack_residual(next);
    next_velocities[i] = vec4(v.xyz + correction.v, uint(v.w) & ~VOILE_VERTEX_TOUCHES); // contact follows, and adds that
}
