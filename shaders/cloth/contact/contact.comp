#version 460
#extension GL_GOOGLE_include_directive : require
// Contact of all cloths with all colliders: detection and response, one thread a vertex.
//
// Reads the state that integration proposes and the state before the substep, writes the substep's result: what it changes of
// the proposed state, or all of it into the state before. The vertex ends on the offset surface, its approaching velocity is
// removed, and Coulomb friction acts on the rest: it sticks while the tangential impulse stays within mu_s times the normal
// one, else it slides with mu_k times it.
// Reads: cloths, patches, mesh lists, colliders and their motions, hierarchies, proposed state and what features change of it,
// own previous state, residuals of both, the way out of what the vertex is inside of, the colliders near a patch.
// Writes: the one or the other state (velocity.w: 1 = touches), predicted velocities, candidates.
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const int METHOD = 1;
layout(constant_id = 3) const uint COLLIDERS_MOVE = 1;
layout(constant_id = 4) const uint COLLIDERS_CONVEX = 1;
layout(constant_id = 5) const uint NEAR_LISTS = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Patches { Patch patches[]; };
layout(set = 0, binding = 2, std430) buffer ProposedPositions { vec4 proposed_positions[]; };
layout(set = 0, binding = 3, std430) buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(set = 0, binding = 4, std430) buffer Positions { vec4 positions[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Velocities { vec4 velocities[]; };
layout(set = 0, binding = 6, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 7, std430) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 8, std430) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(set = 0, binding = 9, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 10, std430) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(set = 0, binding = 11, std430) buffer ProposedPredicted { vec4 proposed_predicted[]; };
layout(set = 0, binding = 12, std430) writeonly buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet

layout(set = 0, binding = 13, std430) buffer CandidatePlaces { vec4 candidate_places[]; };
layout(set = 0, binding = 14, std430) buffer CandidateTriangles { uint candidate_triangles[]; };
layout(set = 0, binding = 15, std430) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(set = 0, binding = 16, std430) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(set = 0, binding = 17, std430) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(set = 0, binding = 18, std430) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(set = 0, binding = 19, std430) readonly buffer Corrections { FeatureCorrection corrections[]; };
layout(set = 0, binding = 20, std430) buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(set = 0, binding = 21, std430) buffer Residuals { uvec2 residuals[]; };
layout(set = 0, binding = 22, std430) readonly buffer Depenetrations
{
    uint recovery_sizes[2 * VOILE_DISPATCH_WORDS];
    Depenetration depenetrations[];
};
layout(set = 0, binding = 23, std430) readonly buffer NearColliders { uint near_colliders[]; };

layout(push_constant, std430) uniform Push { ContactPush push; };

// m: what lies nearer together than this, near x of a collider's space, is the same to a few roundings of a coordinate.
float rounding(vec3 x)
{
    return 5e-7 * max(max(abs(x.x), abs(x.y)), abs(x.z));
}

// m: a vertex that is nearer to the offset surface than this rests on it. Rounding moves both, more so where triangles are
// long; of a plane it counts along its normal.
float contact_slop(ColliderRecord collider, vec3 x, float thickness)
{
    return max(rounding(collider.kind == VOILE_COLLIDER_PLANE ? collider.shape.xyz * x : x), 5e-4 * thickness);
}

#define VOILE_NORMAL_POSITIONS proposed_positions
#define VOILE_NORMAL_RESIDUALS proposed_residuals
#include "shared/vertex_normal.glsl"
#include "colliders/collider_pose.glsl"
#define VOILE_NEAR_LISTS (NEAR_LISTS != 0)
#include "colliders/near_colliders.glsl"
#include "contact/contact_query.glsl"
#include "contact/contact_candidates.glsl"
#include "shared/fine_position.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"

struct Motion
{
    FinePosition from; // before the substep
    vec3 displacement; // m, since then
    vec3 v;            // m/s
    uint cloth;
};

// As a float tells it.
vec3 position_of(Motion motion) { return motion.from.x + motion.displacement; }

// What contact needs of the vertex's cloth.
struct ClothContact
{
    float thickness; // m
    float static_friction;
    float kinetic_friction;
    vec3 normal; // at the vertex, for VOILE_METHOD_NORMAL_RAY
};

// The substep as collider c sees it: the way of the vertex in the collider's space.
struct Passage
{
    bool moves;
    Pose end;   // where it moves
    Pose start;
    PoseChange change; // from start to end
    vec3 from;
    vec3 to;
};

Passage passage_of(uint c, uint flags, Motion motion)
{
    Passage result;
    result.moves = is_moved(flags);
    result.from = from_origin(c, flags, motion.from);
    precise const vec3 to = result.from + motion.displacement;
    result.to = to;
    if (result.moves)
    {
        result.start = pose_at(c, push.progress_from);
        result.end = pose_at(c, push.progress_to);
        result.change = pose_change(c, push.progress_from, push.progress_to);
        result.from = to_collider(result.start, result.from);
        result.to = to_collider(result.end, result.to);
    }
    return result;
}

// By how much the surface moves in the substep, m, at a place of its end in the collider's space. `way`: by deforming.
vec3 surface_way(Passage passage, vec3 place, vec3 way)
{
    if (!passage.moves)
        return way;
    return displacement(passage.start, passage.change, place) + rotate(passage.start.rotation, way);
}

vec3 world_direction(Passage passage, vec3 direction)
{
    return passage.moves ? rotate(passage.end.rotation, direction) : direction;
}

// m: by how much a contact moves the vertex. What has come nearer than the thickness goes back at once. What was too near
// before comes away slowly, and what was inside no faster than that: neighbors that part faster would load the springs.
float lift_of(Contact contact, float thickness)
{
    const float lift = min(thickness, contact.start + VOILE_RECOVERY_SPEED * push.step) - contact.gap;
    return contact.start < 0 ? lift : max(lift, 0);
}

// `n`: world, unit, away from the surface; `lift`: m along it; `way`: m, of the surface in this substep.
// `slop`: m, see contact_slop.
void respond(inout Motion motion, vec3 n, float lift, vec3 way, float slop, float static_friction,
             float kinetic_friction)
{
    motion.displacement += lift * n;
    const vec3 relative = motion.v - way / push.step;
    const float approach = min(dot(relative, n), 0);
    motion.v -= approach * n;
    const float normal_impulse = -approach; // per unit of mass, m/s
    if (normal_impulse == 0)
        return;

    const vec3 v_t = relative - dot(relative, n) * n;
    const float speed = length(v_t);
    if (speed <= static_friction * normal_impulse)
    {
        // Sticks: what it slid within the substep is taken back too, or a held vertex would creep by a h^2 / 2 a substep.
        // To the bit: roundings that add up would stretch stiff cloth until it slips.
        const float height = dot(motion.displacement - way, n);
        motion.displacement = way + (abs(height) > slop ? height : 0) * n;
        motion.v -= v_t;
        return;
    }
    const vec3 change = (slip_speed(speed, normal_impulse, static_friction, kinetic_friction) / speed - 1) * v_t;
    motion.v += change;
    // The flags are read here and not kept through the queries, which are slower with one more register (bench/NOTES.md).
    motion.displacement += drift_time(is_verlet(cloths[motion.cloth].flags), push.step) * change;
}

// What contact knows of the vertex.
struct Meeting
{
    bool touches;
    bool stays_out; // what has moved it leads through no surface
};

// Inside a collider the velocity that forces give a vertex decays in this time, s, and stays below this speed, m/s: neighbors
// whose ways out differ hold each other together. Of the velocity at which it goes out they take back this fraction at most, so
// that none is held inside.
#define VOILE_INSIDE_TIME 0.01
#define VOILE_INSIDE_SPEED 0.6
#define VOILE_INSIDE_BACK 0.5

// A vertex inside a collider goes along with that, and out of it at a given speed. It gets no velocity from that.
void leave(inout Motion motion, Depenetration depenetration)
{
    const uint c = depenetration.solid - 1;
    const Passage passage = passage_of(c, colliders[c].flags, motion);
    // A collider that jumps would throw what it leaves behind.
    vec3 surface = surface_way(passage, passage.from, vec3(0)) / push.step;
    surface *= min(1, VOILE_RECOVERY_SPEED / max(length(surface), 1e-30));
    vec3 own = motion.v - surface;
    own *= min(max(1 - push.step / VOILE_INSIDE_TIME, 0), VOILE_INSIDE_SPEED / max(length(own), 1e-30));
    const float speed = length(depenetration.velocity);
    const vec3 out_of_it = depenetration.velocity / max(speed, 1e-30);
    own -= min(dot(own, out_of_it) + VOILE_INSIDE_BACK * speed, 0) * out_of_it;
    motion.v = surface + own;
    motion.displacement = push.step * (motion.v + depenetration.velocity);
}

// Where the way of the vertex leads through a surface after all.
void keep_out(inout Motion motion, Passage passage, Contact contact)
{
    const vec3 way = surface_way(passage, passage.from + contact.way, contact.way);
    const vec3 n = world_direction(passage, contact.direction);
    motion.displacement = way;
    motion.v -= min(dot(motion.v - way / push.step, n), 0) * n;
}

// `last`: in the round that looks for what the way leads through.
void meet(inout Motion motion, uint c, bool last, ClothContact cloth, inout Meeting meeting)
{
    const ColliderRecord collider = colliders[c];
    const Passage passage = passage_of(c, collider.flags, motion);
    const vec3 normal = passage.moves ? rotate_back(passage.end.rotation, cloth.normal) : cloth.normal;
    // A vertex that rests lies on the offset surface within rounding, and touches it on either side of that.
    const float slop = contact_slop(collider, passage.from, cloth.thickness);
    const float reach = last ? 0 : cloth.thickness + slop;
    const Contact contact = find_contact(c, collider, last ? VOILE_METHOD_PATH_ALONE : METHOD, passage.from, passage.to,
                                         normal, reach);
    if (!contact.found)
        return;
    if (last)
    {
        keep_out(motion, passage, contact);
        meeting.stays_out = true;
        return;
    }
    // Nothing is nearer than this contact: what moves the vertex by less than its gap leads through no surface.
    const float farthest = cloth.thickness - contact.gap + distance(passage.from, passage.to);
    meeting.stays_out = !meeting.touches && farthest < contact.gap;
    meeting.touches = true;
    const vec3 n = world_direction(passage, contact.direction);
    const vec3 way = surface_way(passage, passage.to - contact.gap * contact.direction, contact.way);
    if (contact.start < 0)
        motion.v -= dot(motion.v - way / push.step, n) * n; // it comes out without a velocity of its own
    respond(motion, n, lift_of(contact, cloth.thickness), way, slop,
            pair_friction(cloth.static_friction, collider.static_friction, collider.flags),
            pair_friction(cloth.kinetic_friction, collider.kinetic_friction, collider.flags));
}

ColliderWalk walk_path(Motion motion)
{
    const vec3 to = position_of(motion);
    return walk_colliders(gl_WorkGroupID.x, min(motion.from.x, to), max(motion.from.x, to));
}

// Responses to several surfaces, or to one in a narrow gap, can push a vertex through another surface. So there is a second
// round: where the way from its last place leads through one, the vertex stays at that last place, as the surface carries it,
// so that it is never on the wrong side. One loop for both rounds: their queries are most of this kernel.
// `leaves`: the vertex is brought out of a solid. No solid stops it meanwhile: of two that overlap, each would hold what the
// other releases.
Meeting meet_all(inout Motion motion, ClothContact cloth, bool leaves)
{
    Meeting meeting = Meeting(false, false);
    bool last = false;
    ColliderWalk walk = walk_path(motion);
    while (true)
    {
        uint c;
        if (!next_collider(walk, c))
        {
            if (last || !meeting.touches || meeting.stays_out)
                break;
            last = true;
            walk = walk_path(motion);
            continue;
        }
        if (leaves && is_solid(colliders[c]))
            continue;
        meet(motion, c, last, cloth, meeting);
        if (meeting.touches)
            keep_walking(walk, c, position_of(motion));
    }
    return meeting;
}

// What integration proposes, corrected by features where they have met the vertex in this substep; `flags` of the velocity.
Motion propose(uint i, uint cloth, vec3 proposed, out uint flags)
{
    const vec4 velocity = proposed_velocities[i];
    Motion motion;
    motion.from = FinePosition(positions[i].xyz, unpack_residual(residuals[i]));
    motion.displacement = displacement(motion.from, FinePosition(proposed, unpack_residual(proposed_residuals[i])));
    motion.v = velocity.xyz;
    motion.cloth = cloth;
    flags = uint(velocity.w);
    if (push.features != 0 && patches[gl_WorkGroupID.x].near_features != 0 && corrections[i].substep == push.substep)
    {
        motion.displacement += corrections[i].shift;
        motion.v += corrections[i].change;
        flags |= VOILE_VERTEX_MEETS;
    }
    return motion;
}

// How the vertex comes out of what it is inside of. All load this only where any is inside.
Depenetration depenetration_of(uint i)
{
    if (push.recovers == 0 || recovery_sizes[push.recovery] == 0)
        return Depenetration(vec3(0), 0);
    return depenetrations[i];
}

// `flags` of the velocity, VOILE_VERTEX_...
void commit(uint i, Motion motion, uint flags)
{
    const FinePosition to = moved(motion.from, motion.displacement);
    const vec4 position = vec4(to.x, proposed_positions[i].w);
    const vec4 velocity = vec4(motion.v, flags);
    const vec4 change = vec4(motion.v - proposed_velocities[i].xyz, 0);
    const bool verlet = is_verlet(cloths[motion.cloth].flags);
    if (push.in_place == 0)
    {
        positions[i] = position;
        residuals[i] = pack_residual(to);
        velocities[i] = velocity;
        if (verlet)
            predicted[i] = proposed_predicted[i] + change;
        return;
    }
    proposed_positions[i] = position;
    proposed_residuals[i] = pack_residual(to);
    proposed_velocities[i] = velocity;
    if (verlet)
        proposed_predicted[i] += change;
}

// What contact leaves alone is the same to the bit in either place.
void take_over(uint i, uint cloth, vec4 proposed)
{
    positions[i] = proposed;
    residuals[i] = proposed_residuals[i];
    velocities[i] = proposed_velocities[i];
    if (is_verlet(cloths[cloth].flags))
        predicted[i] = proposed_predicted[i];
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    if (!self.exists)
        return;
    const uint i = self.index;
    const uint cloth = self.cloth;
    const vec4 proposed = proposed_positions[i];
    uint flags;
    Motion motion = propose(i, cloth, proposed.xyz, flags);
    bool changed = flags != 0;
    if (proposed.w > 0)
    {
        query_progress = vec2(push.progress_from, push.progress_to);
        query_layers = cloths[cloth].layers;
        ClothContact contact;
        contact.thickness = cloths[cloth].thickness;
        contact.static_friction = cloths[cloth].static_friction;
        contact.kinetic_friction = cloths[cloth].kinetic_friction;
        contact.normal = METHOD == VOILE_METHOD_NORMAL_RAY ? vertex_normal(self) : vec3(0);
        const Depenetration depenetration = depenetration_of(i);
        if (depenetration.solid != 0)
        {
            leave(motion, depenetration);
            changed = true;
        }
        find_candidates(i, motion.from, motion.displacement, motion.v, contact.thickness);
        if (meet_all(motion, contact, depenetration.solid != 0).touches)
        {
            flags |= VOILE_VERTEX_TOUCHES;
            changed = true;
        }
    }
    if (changed)
        commit(i, motion, flags);
    else if (push.in_place == 0)
        take_over(i, cloth, proposed);
}
