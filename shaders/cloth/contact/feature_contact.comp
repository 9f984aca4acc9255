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
// Features of a collider that a cloth is being brought out of (recover.comp) do not hold the cloth back. A sheet that
// the collider protrudes through would be stretched across its edges until it snaps free.
// Reads: near patches (feature_reach.comp), cloths, patches, mesh lists, colliders and their motions, features and
// their hierarchy, positions before the substep, proposed state, residuals of both, this step's depenetration votes.
// Writes: corrections of vertices in contact, which the contact kernel adds to the proposed state; predicted
// velocities.
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 3) const uint COLLIDERS_MOVE = 1;

layout(set = 0, binding = 0, std430) readonly buffer Cloths { ClothRecord cloths[]; };
layout(set = 0, binding = 1, std430) readonly buffer Patches { Patch patches[]; };
layout(set = 0, binding = 2, std430) readonly buffer ProposedPositions { vec4 proposed_positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer ProposedVelocities { vec4 proposed_velocities[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Corrections { FeatureCorrection corrections[]; };
layout(set = 0, binding = 5, std430) readonly buffer NearPatches { uint near_patches[]; };
layout(set = 0, binding = 6, std430) buffer Predicted { vec4 predicted[]; }; // of cloths that use Verlet
layout(set = 0, binding = 7, std430) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(set = 0, binding = 8, std430) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(set = 0, binding = 9, std430) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(set = 0, binding = 10, std430) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(set = 0, binding = 11, std430) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(set = 0, binding = 12, std430) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(set = 0, binding = 13, std430) readonly buffer Features { Feature features[]; };
layout(set = 0, binding = 14, std430) readonly buffer EarlierPositions { vec4 earlier_positions[]; }; // before the substep
layout(set = 0, binding = 15, std430) readonly buffer NearColliders { uint near_colliders[]; };
layout(set = 0, binding = 16, std430) readonly buffer ProposedResiduals { uvec2 proposed_residuals[]; };
layout(set = 0, binding = 17, std430) readonly buffer EarlierResiduals { uvec2 earlier_residuals[]; };
layout(set = 0, binding = 18, std430) readonly buffer Votes { uint votes[]; }; // of each cloth

layout(push_constant, std430) uniform Push { FeaturePush push; };

#include "shared/box.glsl"
#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/friction.glsl"
#include "integration/integrator.glsl"
#include "colliders/near_colliders.glsl"
#include "shared/mesh.glsl"
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
    const uint count = corner_count();
    for (uint k = part; k < count; k += parts)
    {
        if (!load_piece(k))
            continue;
        const Box box = piece_box();
        FeatureQuery query = FeatureQuery(Box(max(box.min, around.min), min(box.max, around.max)));
        traverse_bvh(query, set.first_node, set.first_feature);
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
        walk_colliders(near_patches[gl_WorkGroupID.x], box_around(self.earlier.x, self.proposed.x));
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
    self.vertex = patch_vertex(near_patches[gl_WorkGroupID.x],
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
