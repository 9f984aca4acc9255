#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the patches of cloth near features of colliders until the next such pass. feature_contact.comp runs over these
// patches only, by an indirect dispatch. One thread per vertex.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/feature_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(feature_nodes)) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(feature_dispatch)) buffer FeatureDispatch { uint dispatch_size[]; };
layout(VOILE_BINDING(feature_patches)) writeonly buffer FeaturePatches { uint near_patches[]; };
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };

layout(push_constant, std430) uniform Push { NearFeaturesPush push; };

#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "colliders/near_colliders.glsl"

shared uint near_vertices;

struct FeatureSearch
{
    Box box;
    bool found;
};

// The first leaf suffices.
bool enters_node(FeatureSearch search, Box node) { return !search.found && overlap(search.box, node); }
void visit_leaf(inout FeatureSearch search, uint first, uint count) { search.found = true; }

#define VOILE_QUERY FeatureSearch
#include "colliders/bvh.glsl"

// Whether a feature of collider c is near. `margin`: m, the longest displacement of the vertex until the next pass.
bool has_near_feature(uint c, uint cloth, vec3 position, float margin)
{
    const FeatureSet set = feature_sets[c];
    const uint flags = colliders[c].flags;
    // The residual is far smaller than the cloth's edges.
    vec3 from = from_origin(c, flags, FinePosition(position, vec3(0)));
    vec3 to = from;
    if (is_moved(flags))
    {
        from = to_collider(pose_at(c, push.progress_from), to);
        to = to_collider(pose_at(c, push.progress_to), to);
        margin += 0.5 * distance(from, to); // on the arc between them
    }
    const float radius = margin + VOILE_MOST_STRETCH * set.edge + cloths[cloth].thickness;
    FeatureSearch search = FeatureSearch(grown(box_around(from, to), radius), false);
    if ((colliders[c].layers & cloths[cloth].layers) != 0 && overlap(search.box, Box(set.box_min, set.box_max)))
        traverse_bvh(search, set.first_node, set.first_feature);
    return search.found;
}

bool has_near_feature(PatchVertex self, vec3 position)
{
    const float margin = max(2 * length(velocities[self.index].xyz), push.sudden) * push.time;
    ColliderWalk walk = walk_colliders(push.first_patch + gl_WorkGroupID.x, grown(Box(position, position), margin));
    uint c;
    while (next_collider(walk, c))
        if (feature_sets[c].features > 0 && has_near_feature(c, self.cloth, position, margin))
            return true;
    return false;
}

void main()
{
    if (gl_LocalInvocationID.x == 0)
        near_vertices = 0;
    barrier();
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    const vec4 position = self.exists ? positions[self.index] : vec4(0);
    if (position.w > 0 && has_near_feature(self, position.xyz))
        atomicOr(near_vertices, 1);
    barrier();
    if (gl_LocalInvocationID.x > 0)
        return;
    patches[push.first_patch + gl_WorkGroupID.x].near_features = near_vertices;
    if (near_vertices != 0)
        near_patches[push.first_patch + atomicAdd(dispatch_size[push.dispatch_word], 1)] =
            push.first_patch + gl_WorkGroupID.x;
}
