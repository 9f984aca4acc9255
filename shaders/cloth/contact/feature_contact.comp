#version 460
#extension GL_GOOGLE_include_directive : require
// Contact of feature edges and feature vertices of colliders with the triangles and edges of all cloths. The contact of
// vertices misses colliders between them. Each vertex takes its fraction of the contacts of the triangles around it.
// Several threads per vertex (gl_NumWorkGroups.y) query these triangles, and the first of them merges the results.
//
// Vertices of a triangle move along straight lines within the substep. A triangle that comes closer than the thickness,
// or crosses the feature, is put back at the thickness. Its vertices share the correction by the barycentric
// coordinates of the contact. Approaching velocity is removed. Coulomb friction acts at the contact if the piece is
// fast, and on the vertex if that is slow. Pieces with a pinned vertex are skipped. The contact of vertices comes after
// and overrides.
//
// While depenetration moves a cloth out of a collider (depenetrate.comp), features of that collider do not push the
// cloth back. A sheet that the collider protrudes through would be stretched across its edges until it snaps free.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(proposed_positions)) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(VOILE_BINDING(proposed_velocities)) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(VOILE_BINDING(feature_corrections)) writeonly buffer FeatureCorrections { FeatureCorrection corrections[]; };
layout(VOILE_BINDING(feature_patches)) readonly buffer FeaturePatches { uint near_patches[]; };
layout(VOILE_BINDING(proposed_predicted)) buffer ProposedPredicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(feature_nodes)) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(features)) readonly buffer Features { Feature features[]; };
layout(VOILE_BINDING(earlier_positions)) readonly buffer EarlierPositions { vec4 earlier_positions[]; }; // before the substep
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };
layout(VOILE_BINDING(proposed_residuals)) readonly buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(VOILE_BINDING(earlier_residuals)) readonly buffer EarlierResiduals { uvec2 earlier_residuals[]; };
layout(VOILE_BINDING(feature_centers)) readonly buffer FeatureCenters { vec4 feature_centers[]; };
layout(VOILE_BINDING(feature_lists)) readonly buffer FeatureLists { uint feature_lists[]; };
layout(VOILE_BINDING(step_votes)) readonly buffer StepVotes { uint votes[]; }; // of each cloth

layout(push_constant, std430) uniform Push { FeaturePush push; };

#include "shared/box.glsl"
#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"
#include "colliders/near_colliders.glsl"
#include "shared/mesh.glsl"
#include "contact/feature_fan.glsl"
#include "contact/feature_lists.glsl"
#include "contact/feature_pieces.glsl"
#include "contact/feature_response.glsl"

// Per thread of the workgroup. Threads of one vertex are adjacent.
shared Response responses[gl_WorkGroupSize.x];

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

void visit_leaf(inout FeatureQuery query, uint first, uint count)
{
    for (uint f = first; f < first + count; ++f)
        visit_feature(features[f]);
}

#define VOILE_QUERY FeatureQuery
#include "colliders/bvh.glsl"

// The sum of the exit directions of the cloth's vertices, in the collider's space; 0 if none is inside it.
vec3 exit_direction(uint cloth, uint c)
{
    const uint word = VOILE_VOTE_WORDS * cloth;
    if ((votes[word + VOILE_VOTE_COLLIDERS] & (1u << (c % 32))) == 0)
        return vec3(0);
    const vec3 sum = vec3(int(votes[word + 1]), int(votes[word + 2]), int(votes[word + 3]));
    return collider_moves ? rotate_back(pose_to.rotation, sum) : sum;
}

// Tests the features of the set in the list. `used`: m, of its margin.
void visit_list(uint list, FeatureList near, float used, FeatureSet set, Corner corner)
{
    bool loaded = false;
    for (uint i = 0; i < near.count; ++i)
    {
        const uint entry = feature_lists[entry_word(list, i)];
        const uint feature = feature_of(entry);
        if (excess_of(entry, near.margin) > used || feature - set.first_feature >= set.features)
            continue;
        if (!loaded && !load_piece(corner))
            return;
        loaded = true;
        visit_feature(features[feature]);
    }
}

// Tests the features of the set that the hierarchy finds near the piece. `around`: bounds of all pieces.
void visit_hierarchy(FeatureSet set, Corner corner, Box around)
{
    if (!load_piece(corner))
        return;
    const Box box = piece_box();
    FeatureQuery query = FeatureQuery(Box(max(box.min, around.min), min(box.max, around.max)));
    traverse_bvh(query, set.first_node, set.first_feature);
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
    const Box around = grown(box_around(piece.a.from, piece.a.to), loose);
    if (!is_near(around, Box(set.box_min, set.box_max)))
        return;
    friction = find_friction();
    exits_along = exit_direction(self.vertex.cloth, c);
    const float own_drift = drift(self.vertex.index, self.earlier.x, self.proposed.x);
    const uint count = corner_count(self.vertex);
    for (uint k = part; k < count; k += parts)
    {
        const Corner corner = corner_at(k);
        if (!corner.exists)
            continue;
        const uint list = list_of(self.vertex, k, corner.triangle);
        const FeatureList near = unpacked(feature_lists[head_word(list)]);
        float used = max(own_drift, drift(corner.b));
        if (corner.triangle)
            used = max(used, drift(corner.c));
        if (near.count <= VOILE_FEATURE_ENTRIES && used <= near.margin)
            visit_list(list, near, used, set, corner);
        else
            visit_hierarchy(set, corner, around);
    }
}

void visit_colliders(uint part, uint parts)
{
    const uint i = self.vertex.index;
    const uint cloth = self.vertex.cloth;
    self.earlier = earlier_position(i);
    self.proposed = proposed_position(i);
    self.inverse_mass = proposed_positions[i].w;
    self.velocity = proposed_velocities[i].xyz;
    self.thickness = cloths[cloth].thickness;
    if (self.inverse_mass == 0)
        return;
    ColliderWalk walk =
        walk_colliders(near_patches[push.first_patch + gl_WorkGroupID.x], box_around(self.earlier.x, self.proposed.x));
    uint c;
    while (next_collider(walk, c))
        visit_collider(c, part, parts);
}

void write_correction()
{
    const uint i = self.vertex.index;
    corrections[i] = FeatureCorrection(response.shift, push.substep, response.change, 0);
    if (is_verlet(cloths[self.vertex.cloth].flags))
        predicted[i] += vec4(response.change, 0);
}

void main()
{
    const uint parts = gl_NumWorkGroups.y;
    const uint thread = gl_LocalInvocationID.x;
    const uint part = thread % parts;
    self.vertex = patch_vertex(near_patches[push.first_patch + gl_WorkGroupID.x],
                               (gl_WorkGroupID.y * gl_WorkGroupSize.x + thread) / parts);
    if (self.vertex.exists)
        visit_colliders(part, parts);
    responses[thread] = response;
    barrier();
    if (part > 0)
        return;
    for (uint other = thread + 1; other < thread + parts; ++other)
        merge(responses[other]);
    if (response.collider == k_no_collider)
        return;
    select_collider(response.collider);
    friction = find_friction();
    add_friction();
    write_correction();
}
