// The margin within which features are near a vertex: as far as it may come before the next query.
//
// The threads of a vertex share its margin. If no vertex of a workgroup reaches the features of a collider, none of them
// searches.
//
// The including kernel declares positions[], velocities[], residuals[], colliders[], feature_sets[], feature_centers[] and
// push (NearFeaturesPush), and includes feature_surrounding.glsl, near_colliders.glsl and feature_room.glsl before.
#ifndef VOILE_FEATURE_MARGIN_GLSL
#define VOILE_FEATURE_MARGIN_GLSL

// The margin of cloth at rest, as a fraction of the thickness.
const float k_resting_margin = 0.5;
// Of moving cloth, as a fraction of the displacement that it will have at its velocity.
const float k_moving_margin = 1.25;

shared uint reaching_vertices; // of the workgroup, those that reach the features of a collider

// Of all features of a collider, in its space.
Box feature_box(uint c)
{
    if (is_deforming(colliders[c].flags))
        return padded_box(colliders[c].first_node);
    return Box(feature_sets[c].box_min, feature_sets[c].box_max);
}

bool may_touch(uint c, PatchVertex self)
{
    return feature_sets[c].features > 0 && (colliders[c].layers & cloths[self.cloth].layers) != 0;
}

// m: the thickness with room for rounding. `far`: m, from the origin of the collider's space.
float query_radius(PatchVertex self, vec3 far) { return 1.01 * cloths[self.cloth].thickness + rounding(far); }

// m: the margin for the vertex's pieces, for the collider relative to which they move fastest. Those whose features are
// out of reach do not count: results must not depend on distant colliders. `reaches`: there are others.
float find_margin(PatchVertex self, Box walked, out bool reaches)
{
    const float thickness = cloths[self.cloth].thickness;
    float margin = k_resting_margin * thickness;
    reaches = false;
    ColliderWalk walk = walk_colliders(patch_of_group(), walked);
    uint c;
    while (next_collider(walk, c))
    {
        if (!may_touch(c, self))
            continue;
        const Surrounding around = surrounding(self, c, colliders[c].flags);
        const float wanted = k_resting_margin * thickness + k_moving_margin * around.longest;
        const float radius = query_radius(self, max(abs(around.box.min), abs(around.box.max)));
        const Box reached = grown(joined(around.box, around.later), radius + max(wanted, sudden_reach()));
        if (!overlap(reached, feature_box(c)))
            continue;
        margin = max(margin, wanted);
        reaches = true;
    }
    return margin;
}

// Of the vertices of the workgroup.
PatchVertex vertex_of_group(uint in_group)
{
    const uint vertices = gl_WorkGroupSize.x / push.lanes;
    return patch_vertex(patch_of_group(), gl_WorkGroupID.x % push.lanes * vertices + in_group);
}

// The colliders that may count for a vertex are in it.
Box walked_box(PatchVertex self)
{
    const vec3 position = positions[self.index].xyz;
    const float speed = length(velocities[self.index].xyz);
    return grown(Box(position, position), max(2 * speed * seconds(push.substeps), sudden_reach()));
}

// Each of the first threads finds the margin of a vertex, for all threads of that vertex.
void find_margins(uint thread)
{
    if (thread >= gl_WorkGroupSize.x / push.lanes)
        return;
    const PatchVertex self = vertex_of_group(thread);
    if (!self.exists)
        return;
    bool reaches;
    lane_counts[thread] = floatBitsToUint(find_margin(self, walked_box(self), reaches));
    if (reaches)
        atomicOr(reaching_vertices, 1);
    const vec3 velocity = velocities[self.index].xyz;
    feature_centers[self.index] =
        FeatureCenter(positions[self.index].xyz, velocity.x, residuals[self.index], velocity.yz);
}

#endif
