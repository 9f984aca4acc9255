// The springs and triangles of a mesh. Included by forces.glsl.
//
// A vertex has up to hundreds of them, one after the other, and the last vertex of a GPU's many holds up all. So they are
// summed up in FORCE_PARTS parts, which as many threads take if there are few vertices, or one thread one after the
// other: the sum has the same bits. Kernels that know both define VOILE_SHARES_FORCES.
#ifndef VOILE_MESH_FORCES_GLSL
#define VOILE_MESH_FORCES_GLSL

layout(constant_id = k_constant_force_parts) const uint FORCE_PARTS = 1;

#include "forces/membrane.glsl"

// A part of a mesh vertex: some of its springs, with the entries of the isometric model beside them, and of the triangles
// around it, with the membrane of a Fabric.
void add_mesh_part(inout Gather g, uint cloth, uint local, uint part, StabilityScales scales)
{
    const uint first_vertex = cloths[cloth].first_vertex;
    const bool uniform_springs = (cloths[cloth].flags & VOILE_CLOTH_UNIFORM_SPRINGS) != 0;
    const MeshVertex vertex = mesh_vertices[cloths[cloth].first_list + local];
    // The next entry is loaded while the current one is computed.
    MeshSpring next;
    if (vertex.springs > part)
        next = mesh_springs[vertex.first_spring + part * MESH_STRIDE];
    for (uint s = part; s < vertex.springs; s += FORCE_PARTS)
    {
        const MeshSpring entry = next;
        next = mesh_springs[vertex.first_spring + min(s + FORCE_PARTS, vertex.springs - 1) * MESH_STRIDE];
        const uint other = first_vertex + (entry.neighbor & ~VOILE_OPPOSITE_BIT);
        const bool opposite = (entry.neighbor & VOILE_OPPOSITE_BIT) != 0;
        const float weight = uniform_springs && entry.weight > 0 ? 1 : entry.weight;
        const SpringClass spring =
            scaled(cloths[cloth].springs[opposite ? VOILE_CLASS_OPPOSITE : VOILE_CLASS_EDGE], weight, scales);
        const bool pulls = has_springs(spring);
        if (!pulls && entry.bending == 0)
            continue;
        const Neighbor neighbor = Neighbor(delta_to(g, other), stage_velocities[other].xyz - g.v);
        if (pulls)
            add_spring(g, spring.stiffness, spring.damping, entry.rest_length, neighbor.delta, neighbor.velocity);
        add_bending(g, neighbor, -entry.bending);
    }
    g.bending *= cloths[cloth].bending.x;
    g.bending_rate *= cloths[cloth].bending.x;
    end_bending(g, cloth, scales);
    if (uniform_springs && !feels_air(cloth))
        return;
    SpringClass membrane[VOILE_MEMBRANE_SPRINGS];
    for (int k = 0; k < VOILE_MEMBRANE_SPRINGS; ++k)
        membrane[k] = scaled(cloths[cloth].springs[VOILE_CLASS_WARP + k], 1, scales);
    MeshCorner next_corner;
    if (vertex.corners > part)
        next_corner = mesh_corners[vertex.first_corner + part * MESH_STRIDE];
    for (uint t = part; t < vertex.corners; t += FORCE_PARTS)
    {
        const uint entry = vertex.first_corner + t * MESH_STRIDE;
        const MeshCorner corner = next_corner;
        next_corner = mesh_corners[vertex.first_corner + min(t + FORCE_PARTS, vertex.corners - 1) * MESH_STRIDE];
        const uint b = first_vertex + corner.b;
        const uint c = first_vertex + corner.c;
        const FinePosition x_b = position_of(b);
        const FinePosition x_c = position_of(c);
        if (!uniform_springs)
            add_membrane(g, membrane, membrane_corners[entry], TriangleCorner(x_b, stage_velocities[b].xyz),
                         TriangleCorner(x_c, stage_velocities[c].xyz));
        if (feels_air(cloth))
            add_air(g, cloth, displacement(g.x, x_b), displacement(g.x, x_c), 1.0 / 3);
    }
}

void add_sums(inout Gather g, Gather other)
{
    g.force += other.force;
    g.energy += other.energy;
    g.bending += other.bending;
    g.air += other.air;
    g.air_rate += other.air_rate;
}

#ifdef VOILE_SHARES_FORCES

// Whether the thread writes the vertex.
bool is_first(PatchVertex own) { return own.exists && gl_LocalInvocationID.x < PATCH_SIZE; }

// Whether the thread has nothing to do.
bool is_idle(PatchVertex own) { return !is_first(own) && (FORCE_THREADS == 1 || own.columns > 0); }

// Whose forces the thread computes: all threads of a mesh's patch meet in merge_parts, also those without a vertex.
PatchVertex force_vertex(PatchVertex own)
{
    return FORCE_THREADS == 1 || own.exists ? own : patch_vertex(patch_of_batch(push.first_patch), 0);
}

// Of all threads but the first ones.
shared vec4 shared_forces[gl_WorkGroupSize.x - PATCH_SIZE + 1]; // w: rate of the air
shared vec4 shared_bending[gl_WorkGroupSize.x - PATCH_SIZE + 1]; // w: the air's x
shared vec2 shared_air[gl_WorkGroupSize.x - PATCH_SIZE + 1];

// What all threads of a vertex have found, in the first of them.
void merge_parts(inout Gather g, uint part)
{
    const uint thread = gl_LocalInvocationID.x;
    if (part > 0)
    {
        shared_forces[thread - PATCH_SIZE] = vec4(g.force, g.air_rate);
        shared_bending[thread - PATCH_SIZE] = vec4(g.bending, g.air.x);
        shared_air[thread - PATCH_SIZE] = g.air.yz;
    }
    barrier();
    if (part > 0)
        return;
    for (uint other = thread; other < gl_WorkGroupSize.x - PATCH_SIZE; other += PATCH_SIZE)
    {
        const vec4 force = shared_forces[other];
        const vec4 bending = shared_bending[other];
        g.force += force.xyz;
        g.bending += bending.xyz;
        g.air += vec3(bending.w, shared_air[other]);
        g.air_rate += force.w;
    }
}

#endif

void gather_mesh(inout Gather g, uint cloth, uint local, StabilityScales scales)
{
#ifdef VOILE_SHARES_FORCES
    if (FORCE_THREADS > 1)
    {
        const uint part = gl_LocalInvocationID.x / PATCH_SIZE;
        add_mesh_part(g, cloth, local, part, scales);
        merge_parts(g, part);
        return;
    }
#endif
    if (FORCE_PARTS == 1)
    {
        add_mesh_part(g, cloth, local, 0, scales);
        return;
    }
    const Gather start = g;
    [[dont_unroll]] for (uint part = 0; part < FORCE_PARTS; ++part)
    {
        Gather sums = start;
        add_mesh_part(sums, cloth, local, part, scales);
        add_sums(g, sums);
    }
}

#endif
