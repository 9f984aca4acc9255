#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Contact of feature edges and feature vertices of colliders with the triangles and edges of all cloths: the response of
// each vertex. The contact of vertices misses colliders between them.
//
// test_features.comp has tested the features near each piece of cloth before. Each vertex merges the contacts of the
// pieces that it is in. Where the list of near features is not valid, because it overflowed or the vertices have moved
// too far, several threads per vertex (push.lanes) traverse the hierarchies of features with the triangles around it,
// and the first of them merges the results. All threads of the workgroup take part in that.
//
// Vertices of a triangle move along straight lines within the substep. A triangle that comes closer than the thickness,
// or crosses the feature, is put back at the thickness. Its vertices share the correction by the barycentric
// coordinates of the contact. Approaching velocity is removed, and no vertex leaves the surface faster than it moved.
// Coulomb friction acts at the contact if the piece is fast, and on the vertex if that is slow. Pieces with a pinned
// vertex are skipped. The contact of vertices comes after and overrides.
//
// Merged responses are not checked against each other. Vertices of fast or squeezed pieces are held by a guard, which
// is kept for contact.comp: contact of vertices may not leave it, either (feature_guard.glsl).
//
// While depenetration moves a cloth out of a collider (depenetrate.comp), features of that collider do not push the
// cloth back. A sheet that the collider protrudes through would be stretched across its edges until it snaps free.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;
layout(constant_id = k_constant_feature_part) const uint FEATURE_PART = VOILE_FEATURES_ALL;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(proposed_positions)) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(VOILE_BINDING(proposed_velocities)) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(VOILE_BINDING(feature_corrections)) writeonly buffer FeatureCorrections { FeatureCorrection corrections[]; };
layout(VOILE_BINDING(feature_guards)) writeonly buffer FeatureGuards { FeatureGuard feature_guards[]; };
layout(VOILE_BINDING(feature_dispatch)) readonly buffer FeatureDispatch { uint dispatch_size[]; };
layout(VOILE_BINDING(feature_patches)) readonly buffer FeaturePatches { uint near_patches[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(feature_nodes)) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(features)) readonly buffer Features { Feature features[]; };
layout(VOILE_BINDING(feature_sources)) readonly buffer FeatureSources { FeatureSource feature_sources[]; };
layout(VOILE_BINDING(feature_slots)) readonly buffer FeatureSlots { uint feature_slots[]; };
layout(VOILE_BINDING(feature_facings)) readonly buffer FeatureFacings { FeatureFacing feature_facings[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(earlier_positions)) readonly buffer EarlierPositions { vec4 earlier_positions[]; }; // before the substep
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };
layout(VOILE_BINDING(proposed_residuals)) readonly buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(VOILE_BINDING(earlier_residuals)) readonly buffer EarlierResiduals { uvec2 earlier_residuals[]; };
layout(VOILE_BINDING(feature_cells)) buffer FeatureCells { FeatureCell cells[]; };
layout(VOILE_BINDING(feature_responses)) readonly buffer FeatureResponses { FeatureResponse feature_responses[]; };
layout(VOILE_BINDING(step_votes)) readonly buffer StepVotes { uint votes[]; }; // of each cloth

layout(push_constant, std430) uniform Push { FeaturePush push; };

#include "shared/box.glsl"
#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"
#include "colliders/near_colliders.glsl"
#include "shared/mesh.glsl"
#include "shared/step_input.glsl"
#include "contact/feature_fan.glsl"
#include "contact/feature_pieces.glsl"
#include "contact/swept_feature.glsl"
#include "contact/feature_response.glsl"
#include "contact/feature_guard.glsl"
#include "contact/feature_lanes.glsl"
#include "contact/feature_cells.glsl"

// The vertices of the patch whose items do not suffice, in no order.
shared uint traversing[gl_WorkGroupSize.x];
shared uint traversing_count;

// Whether two boxes are closer than the thickness.
bool is_near(Box a, Box b)
{
    const vec3 gap = max(max(b.min - a.max, a.min - b.max), vec3(0));
    return dot(gap, gap) <= self.thickness * self.thickness;
}

struct FeatureQuery
{
    Box piece; // of cloth
};

bool enters_node(FeatureQuery query, Box node) { return is_near(query.piece, node); }

void visit_edge(SweptFeature feature, SweptVertex b)
{
    const PieceContact touch = edge_contact(feature, b);
    any_guarded = any_guarded || touch.contact.squeezed || is_fast(longest_motion(b, false, feature));
    if (finds_guards)
        add_plane(guard_plane(feature, b, false, touch.contact.squeezed));
    else if (touch.contact.found)
        respond(impulse_of(touch), edge_portions(touch, b).x, collider_index, motion_of(feature));
}

void visit_feature(SweptFeature feature)
{
    if (feature.now.a != feature.now.b)
    {
        [[dont_unroll]] for (uint k = 0; k < 2; ++k)
        {
            SweptVertex b = piece.b;
            if (k == 1)
                b = piece.c;
            if (k == 0 ? piece.edge_b : piece.edge_c)
                visit_edge(feature, b);
        }
        return;
    }
    if (!piece.triangle)
        return;
    const PieceContact touch = triangle_contact(feature);
    any_guarded = any_guarded || touch.contact.squeezed || is_fast(longest_motion(piece.b, true, feature));
    if (finds_guards)
        add_plane(guard_plane(feature, piece.b, true, touch.contact.squeezed));
    else if (touch.contact.found)
        respond(impulse_of(touch), triangle_portions(touch).x, collider_index, motion_of(feature));
}

// Of a mesh that deforms a leaf is a slot.
void visit_leaf(inout FeatureQuery query, uint first, uint count)
{
    const bool deforms = is_deforming(collider_flags);
    DeformingSet set;
    if (deforms)
    {
        set = deforming_set(collider_index);
        count = feature_slots[first] & ((1u << VOILE_SLOT_FEATURE_BITS) - 1);
        first = feature_slots[first] >> VOILE_SLOT_FEATURE_BITS;
    }
    for (uint f = first; f < first + count; ++f)
        if (!deforms || protrudes(set, f))
            visit_feature(swept_feature(f));
}

#define VOILE_QUERY FeatureQuery
#include "colliders/mesh_traversal.glsl"

Box feature_box(FeatureSet set)
{
    if (!is_deforming(collider_flags))
        return Box(set.box_min, set.box_max);
    return padded_box(colliders[collider_index].first_node);
}

// Tests every `parts`-th piece around the vertex, from the `part`-th on.
void visit_collider(uint c, uint part, uint parts)
{
    const ColliderRecord collider = colliders[c];
    const FeatureSet set = feature_sets[c];
    if (set.features == 0 || (collider.layers & cloths[self.vertex.cloth].layers) == 0)
        return;
    select_collider(c);
    piece.a = swept_vertex(self.earlier, self.proposed, self.velocity, self.inverse_mass);
    // Most vertices are far from all features. Their own positions suffice to decide that.
    const float loose = VOILE_MOST_STRETCH * set.edge;
    const Box around = grown(vertex_box(piece.a, finds_guards), 2 * loose);
    if (!is_near(around, feature_box(set)))
        return;
    prepare_collider();
    const uint count = corner_count(self.vertex);
    for (uint k = part; k < count; k += parts)
    {
        if (!load_piece(k))
            continue;
        any_guarded = any_guarded || is_fast(longest_motion(piece.b, true, vec3(0)));
        const Box box = piece_box(finds_guards);
        FeatureQuery query = FeatureQuery(Box(max(box.min, around.min), min(box.max, around.max)));
        const bool deforms = is_deforming(collider_flags);
        traverse(query, MeshTree(deforms, deforms ? collider.first_node : set.first_node,
                                 deforms ? set.first_node : set.first_feature, collider.triangles));
    }
}

void visit_colliders(uint patch_index, uint part, uint parts)
{
    ColliderWalk walk = walk_colliders(patch_index, thales_box(self.earlier.x, self.proposed.x));
    uint c;
    while (next_collider(walk, c))
        visit_collider(c, part, parts);
}

// False: it is pinned.
bool load_self()
{
    const uint i = self.vertex.index;
    self.earlier = earlier_position(i);
    self.proposed = proposed_position(i);
    self.inverse_mass = proposed_positions[i].w;
    self.velocity = proposed_velocities[i].xyz;
    self.thickness = cloths[self.vertex.cloth].thickness;
    return self.inverse_mass > 0;
}

// The change of the vertex by all contacts, with friction.
void find_change()
{
    if (response.collider == k_no_collider)
        return;
    select_collider(response.collider);
    friction = find_friction();
    if (push.limited_only != 0)
        add_limit_friction();
    else
        add_friction();
}

// Holds the motion within the vertex's guard.
void hold_at_features()
{
    const vec3 proposed = proposed_displacement();
    const HeldMotion motion = HeldMotion(proposed + response.shift, self.velocity + response.change);
    const HeldMotion held = hold(guard, proposed, motion, self.thickness, seconds(push.substeps));
    response.shift += held.displacement - motion.displacement;
    response.change += held.velocity - motion.velocity;
}

void write_correction()
{
    const uint i = self.vertex.index;
    if (response.collider == k_no_collider && !is_guarded)
        return;
    if (is_guarded)
    {
        hold_at_features();
        feature_guards[i] = guard;
    }
    corrections[i] = FeatureCorrection(response.shift, counted_substep(push.substep), response.change, is_guarded ? 1 : 0);
}

// Merges the contacts of the items around the vertex. False: they do not suffice.
bool merge_cells()
{
    const Items items = load_items();
    if (!items.valid || !items.any || !load_self())
        return items.valid;
    for (uint i = 0; i < 4; ++i)
        merge_items(items.firsts[i], items.touched[i], i);
    find_change();
    for (uint i = 0; i < 4 && items.guarded; ++i)
        add_planes(items.firsts[i], items.touched[i], i);
    write_correction();
    return true;
}

// For the next pass.
void clear_touched()
{
    cells[self.vertex.index].touched[1 - (push.pass & 1)] = uvec4(0);
}

// False: the items of the vertex do not suffice.
bool answer_items()
{
    if (FEATURE_PART == VOILE_FEATURES_TRAVERSED)
        return load_items().valid;
    clear_touched();
    return merge_cells();
}

// The contacts of the vertex that the threads of its lanes traverse for, in the first of them. All threads of the workgroup
// call it.
void merge_responses(uint part, bool exists)
{
    const uint thread = gl_LocalInvocationID.x;
    store_response(thread);
    barrier();
    if (part != 0 || !exists)
        return;
    for (uint other = thread + 1; other < thread + push.lanes; ++other)
        merge(stored_response(other));
    find_change();
}

void merge_guards(uint part, bool exists)
{
    const uint first = gl_LocalInvocationID.x - part;
    for (uint other = 1; other < push.lanes; ++other)
    {
        barrier(); // the first lane has read what was there
        if (part == other)
            store_guard(first);
        barrier();
        if (part == 0 && exists)
            merge_stored_guard(first);
    }
}

// The response of the `index`-th vertex of those that traverse, and its guard, if any of its pieces needs one. A loop, for
// drivers copy what it calls, which is most of this kernel.
void traverse(uint patch_index, uint index)
{
    const uint part = gl_LocalInvocationID.x % push.lanes;
    response = no_response();
    clear_guard();
    any_guarded = false;
    bool exists = index < traversing_count;
    if (exists)
    {
        self.vertex = patch_vertex(patch_index, traversing[index]);
        exists = load_self();
    }
    [[dont_unroll]] for (uint round = 0; round < 2; ++round)
    {
        finds_guards = round == 1;
        if (exists && (round == 0 || any_guarded))
            visit_colliders(patch_index, part, push.lanes);
        if (round == 0)
            merge_responses(part, exists);
    }
    finds_guards = false;
    merge_guards(part, exists);
    if (part == 0 && exists)
        write_correction();
    barrier();
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    // Without items until the next query, each pass traverses in all patches.
    if (FEATURE_PART == VOILE_FEATURES_TRAVERSED &&
        gl_WorkGroupID.x >= dispatch_size[push.dispatch_word + VOILE_DISPATCH_PATCHES])
        return;
    if (thread == 0)
        traversing_count = 0;
    barrier();
    const uint patch_index = near_patches[push.first_patch + gl_WorkGroupID.x];
    self.vertex = patch_vertex(patch_index, thread);
    clear_guard();
    if (self.vertex.exists && !answer_items())
        traversing[atomicAdd(traversing_count, 1)] = thread;
    if (FEATURE_PART == VOILE_FEATURES_LISTED)
        return;
    barrier();
    for (uint first = 0; first < traversing_count; first += gl_WorkGroupSize.x / push.lanes)
        traverse(patch_index, first + thread / push.lanes);
}
