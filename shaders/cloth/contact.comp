#version 460
#extension GL_GOOGLE_include_directive : require
// Contact of all cloths with all colliders: detection and response, one thread a vertex.
//
// Reads the state that integration proposes and the state before the substep, writes the substep's result. The vertex ends
// on the offset surface, its approaching velocity is removed, and Coulomb friction acts on the rest: it sticks while the
// tangential impulse stays within mu_s times the normal one, else it slides with mu_k times it.
// Reads: cloths, chunks, mesh lists, colliders, hierarchy, proposed state, own previous state. Writes: state (velocity.w:
// 1 = touches), predicted velocities.
#include "bvh_layout.h"
#include "cloth_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const int METHOD = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Chunks { Chunk chunks[]; };
layout(set = 0, binding = 2, std430) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(set = 0, binding = 4, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 6, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 7, std430) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 8, std430) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(set = 0, binding = 9, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 10, std430) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(set = 0, binding = 11, std430) readonly buffer ProposedPredicted { vec4 proposed_predicted[]; };
layout(set = 0, binding = 12, std430) writeonly buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet

layout(set = 0, binding = 13, std430) buffer CandidatePlaces { vec4 candidate_places[]; };
layout(set = 0, binding = 14, std430) buffer CandidateLeaves { uint candidate_leaves[]; };

layout(push_constant, std430) uniform Push { ContactPush push; };

#define VOILE_NORMAL_POSITIONS proposed_positions
#include "vertex_normal.glsl"
#include "contact_query.glsl"
#include "contact_candidates.glsl"

struct Motion
{
    vec3 from; // m, before the substep
    vec3 x;    // m, now
    vec3 v;    // m/s
};

// A pair's coefficient is the geometric mean of both sides' (Box2D's rule); a collider without one takes the fabric's.
float pair_friction(float fabric, float collider, uint flags)
{
    return (flags & VOILE_COLLIDER_FRICTION) != 0 ? sqrt(fabric * collider) : fabric;
}

void respond(inout Motion motion, Contact contact, float thickness, float static_friction, float kinetic_friction)
{
    const vec3 n = contact.direction;
    motion.x += (thickness - contact.gap) * n;
    const float approach = min(dot(motion.v, n), 0);
    motion.v -= approach * n;
    const float normal_impulse = -approach; // per unit of mass, m/s
    if (normal_impulse == 0)
        return;

    const vec3 v_t = motion.v - dot(motion.v, n) * n;
    const float speed = length(v_t);
    if (speed <= static_friction * normal_impulse)
    {
        // Sticks: what it slid within the substep is taken back too, or a held vertex would creep by a h^2 / 2 a substep.
        const vec3 slid = motion.x - motion.from;
        motion.x -= slid - dot(slid, n) * n;
        motion.v -= v_t;
        return;
    }
    const vec3 change = -min(kinetic_friction * normal_impulse / speed, 1) * v_t;
    motion.v += change;
    motion.x += 0.5 * push.step * change; // the impulse acted throughout the substep
}

// Responses to several surfaces, or to one in a narrow gap, can push a vertex through another surface. Where the way from
// its last place leads through one, it stays at that last place, so that no vertex is ever on the wrong side of a mesh.
void keep_out(inout Motion motion)
{
    for (uint c = 0; c < push.colliders; ++c)
    {
        const Contact contact = path_contact(colliders[c], motion.from, motion.x);
        if (!contact.found)
            continue;
        motion.x = motion.from;
        motion.v -= min(dot(motion.v, contact.direction), 0) * contact.direction;
        return;
    }
}

void main()
{
    const ChunkVertex self = chunk_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const uint i = self.index;
    const uint cloth = self.cloth;
    const vec4 proposed = proposed_positions[i];
    const vec4 proposed_velocity = proposed_velocities[i];
    Motion motion = Motion(positions[i].xyz, proposed.xyz, proposed_velocity.xyz);
    float touches = 0;
    bool stays_out = false;
    if (proposed.w > 0)
    {
        const float thickness = cloths[cloth].thickness;
        const float travelled = distance(motion.from, motion.x);
        find_candidates(i, push.colliders, motion.from, motion.x, length(motion.v), thickness);
        const vec3 normal = METHOD == VOILE_METHOD_NORMAL_RAY ? vertex_normal(self) : vec3(0);
        for (uint c = 0; c < push.colliders; ++c)
        {
            const ColliderRecord collider = colliders[c];
            const Contact contact = find_contact(collider, METHOD, motion.from, motion.x, normal, thickness);
            if (!contact.found)
                continue;
            // Nothing is nearer than this contact: what moves the vertex by less than its gap leads through no surface.
            stays_out = touches == 0 && thickness - contact.gap + travelled < contact.gap;
            touches = VOILE_VERTEX_TOUCHES;
            respond(motion, contact, thickness,
                    pair_friction(cloths[cloth].static_friction, collider.static_friction, collider.flags),
                    pair_friction(cloths[cloth].kinetic_friction, collider.kinetic_friction, collider.flags));
        }
    }
    if (touches > 0 && !stays_out)
        keep_out(motion);
    positions[i] = vec4(motion.x, proposed.w);
    velocities[i] = vec4(motion.v, touches + proposed_velocity.w);
    if ((cloths[cloth].flags & VOILE_CLOTH_VERLET) != 0)
        predicted[i] = proposed_predicted[i] + vec4(motion.v - proposed_velocity.xyz, 0);
}
