#version 460
#extension GL_GOOGLE_include_directive : require
// Contact of all cloths with all colliders: detection and response. One thread per vertex.
//
// Each vertex moves from the state before the substep to the state that integration proposes. It ends on the offset
// surface of what it touches. Its approaching velocity is removed. Coulomb friction acts on the rest: the vertex sticks
// while the tangential impulse is at most mu_s times the normal impulse, else it slides with mu_k times that impulse.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_contact_method) const int METHOD = 1;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;
layout(constant_id = k_constant_colliders_convex) const uint COLLIDERS_CONVEX = 1;
layout(constant_id = k_constant_near_lists) const uint NEAR_LISTS = 1;
layout(constant_id = k_constant_pairs) const uint PAIRS = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(proposed_positions)) buffer ProposedPositions { vec4 proposed_positions[]; };
layout(VOILE_BINDING(proposed_velocities)) buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(VOILE_BINDING(earlier_positions)) buffer EarlierPositions { vec4 positions[]; };
layout(VOILE_BINDING(earlier_velocities)) buffer EarlierVelocities { vec4 velocities[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(bvh_triangles)) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(proposed_predicted)) buffer ProposedPredicted { vec4 proposed_predicted[]; };
layout(VOILE_BINDING(earlier_predicted)) writeonly buffer EarlierPredicted { vec4 predicted[]; }; // of cloths that use Verlet

layout(VOILE_BINDING(candidate_centers)) buffer CandidateCenters { vec4 candidate_centers[]; };
layout(VOILE_BINDING(candidate_triangles)) buffer CandidateTriangles { uint candidate_triangles[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(padded_leaves)) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(feature_corrections)) readonly buffer FeatureCorrections { FeatureCorrection corrections[]; };
layout(VOILE_BINDING(feature_guards)) readonly buffer FeatureGuards { FeatureGuard feature_guards[]; };
layout(VOILE_BINDING(proposed_residuals)) buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(VOILE_BINDING(earlier_residuals)) buffer EarlierResiduals { uvec2 residuals[]; };
layout(VOILE_BINDING(depenetrations)) readonly buffer Depenetrations
{
    uint dispatch_sizes[2 * VOILE_DISPATCH_WORDS];
    Depenetration depenetrations[];
};
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };

layout(VOILE_BINDING(contact_planes)) buffer ContactPlanes { ContactPlane planes[]; };

layout(VOILE_BINDING(pair_bounds)) buffer PairBounds
{
    PairDispatch pair_searches[VOILE_PAIR_SEARCHES];
    PairBound pair_bounds[];
};

layout(VOILE_BINDING(pair_islands)) readonly buffer PairIslands { PairIsland pair_islands[]; };
layout(VOILE_BINDING(tangles)) readonly buffer Tangles { Tangle tangles[]; };

layout(push_constant, std430) uniform Push { ContactPush push; };

#define VOILE_NORMAL_POSITIONS proposed_positions
#define VOILE_NORMAL_RESIDUALS proposed_residuals
#include "shared/vertex_normal.glsl"
#include "shared/step_input.glsl"
#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"

uint patch_of_group() { return patch_of_batch(push.first_patch); }

#define VOILE_NEAR_LISTS (NEAR_LISTS != 0)
#include "colliders/near_colliders.glsl"
#include "contact/contact_query.glsl"
#include "contact/near_walk.glsl"
#include "contact/contact_vertex.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"
#include "pairs/direction.glsl"
#include "pairs/drive.glsl"
#include "pairs/hold.glsl"
#include "pairs/stop.glsl"
#include "pairs/untangle.glsl"

// The flags are read here and not kept through the queries, which are slower with one more register (bench/NOTES.md).
float slip_time(Motion motion) { return drift_time(is_verlet(cloths[motion.cloth].flags), seconds(push.substeps), push.kicks); }

#include "contact/feature_hold.glsl"
#include "contact/proposals.glsl"
#include "contact/response.glsl"
#include "contact/limit_friction.glsl"

// m: a vertex this close to the offset surface rests on it. Rounding moves both, more where triangles are long. For a
// plane only rounding along its normal counts.
float contact_slop(ColliderRecord collider, vec3 x, float thickness)
{
    return max(rounding(collider.kind == VOILE_COLLIDER_PLANE ? collider.shape.xyz * x : x), 5e-4 * thickness);
}

// The motion of a vertex in a collider's space.
struct RelativeMotion
{
    bool moves;
    Pose end;   // of a collider that moves
    Pose start;
    PoseChange change; // from start to end; of a motion that takes no time, in the substep before
    vec3 from;
    vec3 to;
};

RelativeMotion relative_motion(uint c, uint flags, Motion motion)
{
    RelativeMotion result;
    result.moves = is_moved(flags);
    result.from = from_origin(c, flags, motion.from);
    precise const vec3 to = result.from + motion.displacement;
    result.to = to;
    if (result.moves)
    {
        result.start = pose_at(c, push.progress_from);
        result.end = pose_at(c, push.progress_to);
        result.change = pose_change(c, push.progress_before, push.progress_to);
        result.from = to_collider(result.start, result.from);
        result.to = to_collider(result.end, result.to);
    }
    return result;
}

// m, world: the displacement of the surface within the substep, at a point of the collider's space at the substep's
// end.
// `deformation`: m, the part that is due to the mesh's own vertices.
vec3 surface_displacement(RelativeMotion relative, vec3 point, vec3 deformation)
{
    if (!relative.moves)
        return deformation;
    Pose start = relative.start;
    if (push.limited_only != 0)
        start.rotation -= relative.change.rotation;
    return displacement(start, relative.change, point) + rotate(start.rotation, deformation);
}

// The same for a motion that may take no time.
vec3 displacement_within(vec3 surface) { return push.limited_only == 0 ? surface : vec3(0); }

vec3 world_direction(RelativeMotion relative, vec3 direction)
{
    return relative.moves ? rotate(relative.end.rotation, direction) : direction;
}

// m: the correction along the contact's direction. What came closer than the thickness in this substep is put back at
// once. A vertex that was too close before is lifted slowly, and one inside no faster: neighbors that part faster
// would load the springs.
float lift_of(Contact contact, float thickness)
{
    const float lift = min(thickness, contact.start + VOILE_DEPENETRATION_SPEED * seconds(push.substeps)) - contact.gap;
    return contact.start < 0 ? lift : max(lift, 0);
}

// The contacts of a vertex in this substep.
struct ContactState
{
    bool touches;
    bool path_is_clear; // the corrected path crosses no surface
    bool has_plane;     // for the substeps until the next pass
    bool leaves_solid;
    Drive drive;
};

// m/s, of the collider at the vertex. A collider that jumps would throw the vertex, so that it hardly follows faster ones.
vec3 carrying_velocity(Motion motion, Depenetration depenetration)
{
    const uint c = depenetration.solid - 1;
    const RelativeMotion relative = relative_motion(c, colliders[c].flags, motion);
    const vec3 velocity = surface_displacement(relative, relative.from, vec3(0)) / seconds(push.substeps);
    const float part = min(1, VOILE_FOLLOWED_SPEED / max(length(velocity), 1e-30));
    return part * part * part * velocity;
}

// Moves a vertex that is inside a collider. Verlet has done so in the substeps after the first contact pass of a step, but
// attachments and tethers may have pulled it back. `flags`: VOILE_VERTEX_...
Drive depenetrate(uint i, uint flags, inout Motion motion, Depenetration depenetration)
{
    const vec3 surface = carrying_velocity(motion, depenetration);
    if (push.limited_only == 0 && (push.kicks == 1 || (flags & VOILE_VERTEX_TAUT) != 0))
        leave(motion, depenetration.velocity, surface, seconds(push.substeps));
    if (push.result == VOILE_CONTACT_KEEPS_START)
        planes[i] = ContactPlane(depenetration.velocity, 0, surface, VOILE_PLANE_OF_EXIT);
    const float speed = length(depenetration.velocity);
    const vec3 outwards = depenetration.velocity / max(speed, 1e-30);
    return Drive(outwards, dot(surface, outwards));
}

// Puts a vertex whose corrected path crosses a surface back to its start, carried by that surface.
void stop_at_start(inout Motion motion, RelativeMotion relative, Contact contact)
{
    const vec3 surface = surface_displacement(relative, relative.from + contact.deformation, contact.deformation);
    motion.displacement = displacement_within(surface);
    motion.v = surface / seconds(push.substeps);
}

Friction pair_friction(Friction fabric, ColliderRecord collider)
{
    return Friction(pair_friction(fabric.at_rest, collider.static_friction, collider.flags),
                    pair_friction(fabric.kinetic, collider.kinetic_friction, collider.flags));
}

Path path_of(RelativeMotion relative, ClothContact cloth, bool path_only, float radius)
{
    const vec3 normal = relative.moves ? rotate_back(relative.end.rotation, cloth.normal) : cloth.normal;
    return Path(path_only ? k_method_path_only : METHOD, relative.from, relative.to, normal, path_only ? 0 : radius,
                cloth.layers);
}

// Keeps the surface for the substeps until the next contact pass. `slack`: m, of the start of the motion above what
// counts as touching.
void keep_plane(uint i, Surface surface, float slack)
{
    planes[i] = ContactPlane(surface.normal, slack, surface.velocity,
                             packHalf2x16(vec2(surface.friction.at_rest, surface.friction.kinetic)));
}

// The end of the motion is where Verlet goes on.
void end_plane(uint i, Motion motion, bool has_plane)
{
    if (!has_plane)
        planes[i] = ContactPlane(vec3(0), 0, vec3(0), 0);
    else
        planes[i].slack = max(planes[i].slack + dot(motion.displacement, planes[i].normal), 0);
}

// `path_only`: only what the path crosses counts, in the second round.
void resolve_contact(inout Motion motion, uint c, bool path_only, ClothContact cloth, inout Candidates list,
                     inout ContactState state)
{
    const ColliderRecord collider = colliders[c];
    const RelativeMotion relative = relative_motion(c, collider.flags, motion);
    // A vertex at rest lies on the offset surface within rounding. It touches on either side.
    const float slop = contact_slop(collider, relative.from, cloth.thickness);
    const float radius = max(cloth.thickness + slop, query_radius(cloth.thickness));
    const Contact contact = find_contact(c, collider, path_of(relative, cloth, path_only, radius), motion, cloth, list);
    if (!contact.found)
        return;
    if (path_only)
    {
        stop_at_start(motion, relative, contact);
        state.path_is_clear = true;
        return;
    }
    const vec3 n = world_direction(relative, contact.direction);
    const vec3 surface =
        surface_displacement(relative, relative.to - contact.gap * contact.direction, contact.deformation);
    // After the strain limit the velocity of a mesh that deforms is not known. It is taken for that of the cloth.
    const bool follows = push.limited_only != 0 && is_deforming(collider.flags);
    const Surface touched = Surface(n, displacement_within(surface), follows ? motion.v : surface / seconds(push.substeps),
                                    slop, pair_friction(cloth.friction, collider));
    if (push.result == VOILE_CONTACT_KEEPS_START && contact.start >= 0 && !state.leaves_solid)
    {
        keep_plane(list.vertex, touched, contact.gap - cloth.thickness - slop - dot(motion.displacement, n));
        state.has_plane = true;
    }
    if (contact.gap >= cloth.thickness + slop)
        return;
    // Nothing is closer than this contact. A displacement shorter than the gap cannot cross a surface.
    const float longest = cloth.thickness - contact.gap + distance(relative.from, relative.to);
    state.path_is_clear = !state.touches && longest < contact.gap;
    state.touches = true;
    state.drive = Drive(n, push.substeps > 0 ? dot(surface, n) / seconds(push.substeps) : 0);
    if (contact.start < 0)
        motion.v -= dot(motion.v - surface / seconds(push.substeps), n) * n; // it leaves the inside without a velocity of its own
    const float lift = lift_of(contact, cloth.thickness);
    if (push.limited_only != 0)
        motion.displacement -= held_after_limit(motion.displacement, n, max(lift, 0),
                                                vec2(touched.friction.at_rest, touched.friction.kinetic));
    respond(motion, touched, lift);
}

// Responses to several surfaces, or to one surface in a narrow gap, can push a vertex through another surface. A second
// round checks the corrected path. Where it crosses a surface, the vertex stays at its start, so that it is never on
// the wrong side. Both rounds share one loop because their queries are most of this kernel.
// `leaves_solid`: depenetration moves the vertex out of a solid. No solid stops it meanwhile: of two that overlap, each
// would stop a vertex that the other releases.
ContactState resolve_contacts(inout Motion motion, ClothContact cloth, Candidates list, bool leaves_solid)
{
    ContactState state = ContactState(false, false, false, leaves_solid, k_no_drive);
    bool path_only = false;
    NearWalk walk = walk_path(motion);
    while (true)
    {
        uint c;
        if (!next_near(walk, c, motion, cloth.thickness, leaves_solid))
        {
            if (path_only || !state.touches || state.path_is_clear)
                break;
            path_only = true;
            walk = walk_path(motion);
            continue;
        }
        resolve_contact(motion, c, path_only, cloth, list, state);
        if (state.touches)
            continue_walk(walk, c, motion);
    }
    end_list(list);
    return state;
}

// Cuts a motion that contact has changed where the guard of features ends. `shifted`: m, the motion with the correction
// of features.
void hold_at_features(uint i, vec3 shifted, float thickness, inout Motion motion)
{
    if (corrections[i].guarded == 0)
        return;
    const HeldMotion held = cut(feature_guards[i], shifted - corrections[i].shift,
                                HeldMotion(motion.displacement, motion.v), thickness, seconds(push.substeps));
    motion.v = held.velocity;
    motion.displacement = held.displacement;
}

void main()
{
    if (NEAR_LISTS != 0 && push.near_stride != 0)
        stage_colliders();
    const PatchVertex self = patch_vertex(patch_of_group());
    if (!self.exists)
        return;
    const uint i = self.index;
    const uint cloth = self.cloth;
    if (push.limited_only != 0 && cloths[cloth].strain_limit == 0)
        return;
    const vec4 proposed = proposed_positions[i];
    uint flags;
    Motion motion = proposed_motion(i, cloth, proposed.xyz, flags);
    bool changed = flags != 0;
    const bool held = PAIRS != 0 && (cloths[cloth].flags & VOILE_CLOTH_SELF_COLLISION) != 0;
    if (held && proposed.w == 0)
        watch_driven(i, cloth, motion);
    if (proposed.w > 0)
    {
        Hold hold;
        Drive impulse;
        if (held)
        {
            hold = hold_of(i, cloth, motion.from);
            impulse = drive_of(hold.bound.impulse, motion.v - hold.carry);
            changed = slide_along_planes(i, hold, motion) || changed;
            changed = untangle(i, motion) || changed;
        }
        ClothContact contact;
        contact.thickness = cloths[cloth].thickness;
        contact.friction = Friction(cloths[cloth].static_friction, cloths[cloth].kinetic_friction);
        contact.layers = cloths[cloth].layers;
        contact.normal = METHOD == k_method_normal_ray ? vertex_normal(self) : vec3(0);
        const Depenetration depenetration = depenetration_of(i);
        Drive drive = k_no_drive;
        if (depenetration.solid != 0)
        {
            drive = depenetrate(i, flags, motion, depenetration);
            changed = true;
        }
        const vec3 shifted = motion.displacement;
        const ContactState state = resolve_contacts(motion, contact, list_of(i, motion, contact), depenetration.solid != 0);
        if (state.touches)
        {
            flags |= VOILE_VERTEX_TOUCHES;
            drive = state.drive;
            changed = true;
        }
        if (state.touches && (flags & VOILE_VERTEX_TOUCHES_FEATURE) != 0 && depenetration.solid == 0)
            hold_at_features(i, shifted, contact.thickness, motion);
        if (held && COLLIDERS_MOVE != 0 && drive.direction != vec3(0))
        {
            flags |= VOILE_VERTEX_SUPPORTED;
            pair_bounds[i].guard.support = pack_direction(drive.direction);
        }
        if (held && step_input.driven != 0 && (drive.speed > 0 || impulse.speed > k_push))
            flags |= VOILE_VERTEX_PUSHED;
        if (held && hold_within_guards(i, hold, motion))
        {
            changed = true;
            keep(drive, vec3(0), motion.v);
            if ((flags & VOILE_VERTEX_PUSHED) != 0 && !state.touches)
                keep(impulse, hold.carry, motion.v);
        }
        if (push.result == VOILE_CONTACT_KEEPS_START && depenetration.solid == 0)
            end_plane(i, motion, state.has_plane);
    }
    if (changed)
        write_motion(i, motion, flags);
    else
        copy_proposed(i, cloth, proposed);
}
