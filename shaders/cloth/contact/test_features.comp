#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Tests each feature near a piece of cloth (find_near_features.comp) against that piece. One thread per item. Contacts
// are kept with the item, and feature_contact.comp merges those of each vertex. So are planes that fast pieces may not
// cross (feature_guard.glsl).
//
// Guards have no feature. They check that no vertex of a cell, which they share, has moved farther than its margin since the
// items were made, relative to the collider: then no other feature can touch the cell's pieces.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(proposed_positions)) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(VOILE_BINDING(proposed_velocities)) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(VOILE_BINDING(proposed_residuals)) readonly buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(VOILE_BINDING(earlier_positions)) readonly buffer EarlierPositions { vec4 earlier_positions[]; }; // before the substep
layout(VOILE_BINDING(earlier_residuals)) readonly buffer EarlierResiduals { uvec2 earlier_residuals[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(feature_sources)) readonly buffer FeatureSources { FeatureSource feature_sources[]; };
layout(VOILE_BINDING(feature_facings)) readonly buffer FeatureFacings { FeatureFacing feature_facings[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(deforming_reach)) readonly buffer DeformingReach { uint deforming_reach[]; };
layout(VOILE_BINDING(features)) readonly buffer Features { Feature features[]; };
layout(VOILE_BINDING(feature_dispatch)) readonly buffer FeatureDispatch { uint dispatch_size[]; };
layout(VOILE_BINDING(feature_traversals)) buffer FeatureTraversals { uint traversals[]; };
layout(VOILE_BINDING(feature_centers)) readonly buffer FeatureCenters { FeatureCenter feature_centers[]; };
layout(VOILE_BINDING(feature_items)) readonly buffer FeatureItems { FeatureItem items[]; };
layout(VOILE_BINDING(feature_cells)) buffer FeatureCells { FeatureCell cells[]; };
layout(VOILE_BINDING(feature_responses)) writeonly buffer FeatureResponses { FeatureResponse feature_responses[]; };
layout(VOILE_BINDING(step_votes)) readonly buffer StepVotes { uint votes[]; }; // of each cloth

layout(push_constant, std430) uniform Push { FeaturePush push; };

#include "shared/box.glsl"
#include "shared/patch_vertex.glsl"
#include "shared/mesh.glsl"
#include "shared/step_input.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/feature_fan.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"
#include "contact/feature_pieces.glsl"
#include "contact/swept_feature.glsl"
#include "contact/feature_response.glsl"
#include "contact/feature_guard.glsl"
#include "contact/traversal_size.glsl"

// The vertex that an item is of.
PatchVertex item_vertex(uint cloth, uint index)
{
    PatchVertex vertex;
    vertex.exists = true;
    vertex.cloth = cloth;
    vertex.index = index;
    vertex.local = index - cloths[cloth].first_vertex;
    vertex.columns = cloths[cloth].columns;
    vertex.rows = cloths[cloth].rows;
    vertex.column_row = ivec2(0);
    if (vertex.columns > 0)
        vertex.column_row = ivec2(vertex.local % vertex.columns, vertex.local / vertex.columns);
    return vertex;
}

// m: how far a vertex may be from a point after its contacts, in the space of the collider (held_box).
float farthest_of(vec3 point, SweptVertex vertex)
{
    return distance(point, 0.5 * (vertex.from + vertex.to)) + 0.5 * distance(vertex.from, vertex.to);
}

// The same for a collider that deforms: from the straight path in its space that the vertex was expected to take.
float drift_from_path(FeatureCenter listed, FinePosition center, FinePosition earlier, FinePosition proposed)
{
    const float duration = push.progress_next - push.progress_listed;
    const float time = duration / step_input.rate;
    const vec3 from = from_origin(collider_index, collider_flags, center);
    const vec3 to = from + time * vec3(listed.velocity_x, listed.velocity_yz);
    const vec3 start = collider_moves ? to_collider(pose_listed, from) : from;
    vec3 end = to;
    if (collider_moves)
        end = to_collider(pose_at(collider_index, push.progress_next), to);
    const SweptVertex path = swept_vertex(earlier, proposed, vec3(0), 1);
    return max(distance(mix(start, end, (push.progress_from - push.progress_listed) / duration), path.from),
               farthest_of(mix(start, end, (push.progress_to - push.progress_listed) / duration), path));
}

// m: the longest distance of a vertex within the substep from where it was when near features were listed, relative to
// the collider.
float drift(uint index)
{
    const FeatureCenter listed = feature_centers[index];
    const FinePosition center = FinePosition(listed.x, unpack_residual(listed.residual));
    const FinePosition earlier = earlier_position(index);
    const FinePosition proposed = proposed_position(index);
    if (is_deforming(collider_flags))
        return drift_from_path(listed, center, earlier, proposed);
    if (!collider_moves)
    {
        const vec3 half_way = 0.5 * displacement(earlier, proposed);
        return length(displacement(center, earlier) + half_way) + length(half_way);
    }
    const vec3 at = to_collider(pose_listed, from_origin(collider_index, collider_flags, center));
    return farthest_of(at, swept_vertex(earlier, proposed, vec3(0), 1));
}

// m: how far the surface of the current collider may push a vertex off the way that integration proposes.
float longest_push()
{
    if (!is_deforming(collider_flags))
        return 0;
    return uintBitsToFloat(deforming_reach[0]) * (push.progress_to - push.progress_from);
}

// Whether a vertex has moved by `bound` m since near features were listed; also if that is not a number. The k-th guard is of
// vertices of the cell. One loop for all: code that stands once is fetched once (bench/NOTES.md).
bool any_has_moved(float bound, bool is_guard, uint k, uvec3 vertices)
{
    bool result = false;
    const uvec2 range = is_guard ? guarded_range(self.vertex, k) : uvec2(0, 3);
    [[dont_unroll]] for (uint i = range.x; i < range.y; ++i)
    {
        uint vertex = i == 0 ? vertices.x : i == 1 ? vertices.y : vertices.z;
        if (!is_guard || find_in_cell(self.vertex, i, vertex))
            result = result || !(drift(vertex) < bound);
    }
    return result;
}

// m: how far the vertices of a cell may get until its items do not suffice.
float guarded_room(float margin)
{
    // A vertex without a guard may be pushed off its way by as much. By more than the thickness is too much for lists.
    const float longest = longest_push();
    return longest <= self.thickness ? margin - longest : -1;
}

// The portions of the cell's vertices. Of a mesh the first is that of the vertex.
vec4 cell_portions(vec3 portions, uint kind, uint k)
{
    vec4 result = vec4(0);
    if (self.vertex.columns == 0)
        result.x = portions.x;
    else
    {
        const uvec3 in_cell = k_cell_pieces[k];
        result[in_cell.x] = portions.x;
        result[in_cell.y] = portions.y;
        if (kind == VOILE_PIECE_TRIANGLE)
            result[in_cell.z] = portions.z;
    }
    return result;
}

// One bit for each vertex of the cell that the piece has.
uint cell_vertices(uint k)
{
    if (self.vertex.columns == 0)
        return 1;
    const uvec3 in_cell = k_cell_pieces[k];
    return 1u << in_cell.x | 1u << in_cell.y | 1u << in_cell.z;
}

void sweep_piece(uvec3 vertices, bool triangle)
{
    [[dont_unroll]] for (uint i = 0; i < 3; ++i)
    {
        const SweptVertex vertex = swept_vertex(i == 0 ? vertices.x : i == 1 || !triangle ? vertices.y : vertices.z);
        if (i == 0)
            piece.a = vertex;
        if (i == 1)
            piece.b = vertex;
        piece.c = vertex;
    }
}

// Tests the feature against the piece.
void test_piece(uint item, uint kind, uint k, uvec3 vertices)
{
    const bool triangle = kind == VOILE_PIECE_TRIANGLE;
    sweep_piece(vertices, triangle);
    if (!orient_piece(triangle) || min(piece.a.inverse_mass, piece.b.inverse_mass) == 0 || piece.triangle != triangle)
        return;
    prepare_collider();
    const SweptFeature feature = swept_feature(items[item].feature);
    PieceContact touch = no_contact();
    vec3 portions = vec3(0);
    if (triangle)
    {
        touch = triangle_contact(feature);
        portions = triangle_portions(touch);
    }
    else
    {
        touch = edge_contact(feature, piece.b);
        portions = edge_portions(touch, piece.b);
    }
    const GuardPlane plane = guard_plane(feature, piece.b, triangle, touch.contact.squeezed);
    const bool guarded = plane.plane.xyz != vec3(0);
    if (!touch.contact.found && !guarded)
        return;
    if (guarded)
        cells[self.vertex.index].guarded = counted_substep(push.substep);
    Impulse impulse = Impulse(vec3(0), 0, vec3(0), 0);
    vec4 in_cell_portions = vec4(0);
    if (touch.contact.found)
    {
        impulse = impulse_of(touch);
        in_cell_portions = cell_portions(portions, kind, k);
    }
    const FeatureMotion motion = motion_of(feature);
    feature_responses[item] =
        FeatureResponse(impulse.direction, impulse.correction, impulse.slowing, impulse.approach, in_cell_portions,
                        plane.plane, motion.carried, collider_index, motion.turned, cell_vertices(k));
    const uint in_cell = item - cells[self.vertex.index].first;
    atomicOr(cells[self.vertex.index].touched[push.pass & 1][in_cell / 32], 1u << in_cell % 32);
}

uint count_items()
{
    const uint claimed = dispatch_size[push.dispatch_word + VOILE_DISPATCH_CLAIMED];
    return claimed <= push.items ? claimed : dispatch_size[push.dispatch_word + VOILE_DISPATCH_RETRY_CLAIMED];
}

// A vertex of the cell is farther away than its items know.
void ask_for_traversal()
{
    cells[self.vertex.index].invalid = counted_substep(push.substep);
    write_traversal(push.traversal_word, push.pass, dispatch_size[push.dispatch_word + VOILE_DISPATCH_PATCHES]);
}

void main()
{
    if (gl_GlobalInvocationID.x == 0) // for the next pass
        write_traversal(push.traversal_word, push.pass + 1, traversals[push.traversal_word + VOILE_TRAVERSAL_UNLISTED]);
    if (gl_GlobalInvocationID.x >= count_items())
        return;
    const uint index = push.first_item + gl_GlobalInvocationID.x;
    const FeatureItem item = items[index];
    if (item.vertex == VOILE_NO_VERTEX)
        return;
    const uint cloth = item.piece & ((1u << VOILE_ITEM_CLOTH_BITS) - 1);
    const uint kind = item.piece >> VOILE_ITEM_CLOTH_BITS & 3;
    self.vertex = item_vertex(cloth, item.vertex);
    self.thickness = cloths[cloth].thickness;
    select_collider(item.collider & 0xffff);
    const uint k = item.piece >> (VOILE_ITEM_CLOTH_BITS + 2);
    const bool is_guard = kind == VOILE_PIECE_GUARD;
    float bound = unpackHalf2x16(item.collider >> 16).x; // m, of the distance beyond the thickness when it was listed
    uvec3 vertices = uvec3(item.vertex);
    if (is_guard)
        bound = guarded_room(uintBitsToFloat(item.feature));
    else
        vertices = piece_vertices(self.vertex, kind, k);
    if (!any_has_moved(bound, is_guard, k, vertices))
        return;
    if (is_guard)
        ask_for_traversal();
    else
        test_piece(index, kind, k, vertices);
}
