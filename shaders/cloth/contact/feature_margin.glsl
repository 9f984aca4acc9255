// The margin within which features are near a vertex: as far as it may come before the next query.
//
// The threads of a vertex share its margin, and its colliders among them. If no vertex of a workgroup reaches the features
// of a collider, none of them searches there: a character has many colliders, of which a row of a garment is near few.
//
// The including kernel declares positions[], velocities[], residuals[], colliders[], feature_sets[], feature_centers[] and
// push (NearFeaturesPush), and includes feature_surrounding.glsl, near_colliders.glsl and feature_room.glsl before.
#ifndef VOILE_FEATURE_MARGIN_GLSL
#define VOILE_FEATURE_MARGIN_GLSL

// The margin of cloth at rest, as a fraction of the thickness.
const float k_resting_margin = 0.5;
// Of moving cloth, as a fraction of the displacement that it will have at its velocity.
const float k_moving_margin = 1.25;
// Over the query radius: room for rounding.
const float k_rounded_radius = 1.5;

// Of the workgroup.
const uint k_most_separations = 48; // colliders, in the order of the walk; all others count as reached
shared uint separations[k_most_separations]; // m, ordered: the least one of a vertex beyond its query radius
shared uint widest_margin;                   // m, the bits of a float
shared uint reaching_vertices;               // those that reach the features of a collider

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

// m: the largest distance between the boxes along an axis; negative: they overlap.
float separation(Box a, Box b)
{
    const vec3 gap = max(a.min - b.max, b.min - a.max);
    return max(max(gap.x, gap.y), gap.z);
}

// m: the margin for the features of a collider, and their separation. Negative: they are out of reach. Results must not
// depend on distant colliders.
float margin_for(PatchVertex self, uint c, uint position)
{
    const Surrounding around = surrounding(self, c, colliders[c].flags);
    const Box reached = joined(around.box, around.later);
    const float radius = query_radius(self, max(abs(around.box.min), abs(around.box.max)));
    const float wanted = k_resting_margin * cloths[self.cloth].thickness + k_moving_margin * around.longest;
    if (position < k_most_separations)
        atomicMin(separations[position], ordered(separation(reached, feature_box(c)) - k_rounded_radius * radius));
    return overlap(grown(reached, radius + max(wanted, sudden_reach())), feature_box(c)) ? wanted : -1;
}

// m: the margin for the vertex's pieces, for the collider relative to which they move fastest, of every `parts`-th from the
// `part`-th on. Negative: none is in reach. `walked`: of the workgroup.
float find_margin(PatchVertex self, Box walked, uint part, uint parts)
{
    float margin = -1;
    ColliderWalk walk = walk_colliders(patch_of_group(), walked);
    uint c;
    uint position = 0;
    while (next_collider(walk, c))
    {
        if (!may_touch(c, self))
            continue;
        if (position % parts == part)
            margin = max(margin, margin_for(self, c, position));
        ++position;
    }
    return margin;
}

// Whether a vertex of the workgroup may reach the features of a collider, by its position in the walk.
bool is_reached(uint position)
{
    return position >= k_most_separations ||
           from_ordered(separations[position]) <= max(uintBitsToFloat(widest_margin), sudden_reach());
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

// Finds the margins of the vertices. Neighboring threads take different vertices, so that few colliders need few threads.
// `walked`: of the workgroup.
void find_margins(uint thread, Box walked)
{
    const uint vertices = gl_WorkGroupSize.x / push.lanes;
    const uint in_group = thread % vertices;
    const uint part = thread / vertices;
    const PatchVertex self = vertex_of_group(in_group);
    if (!self.exists || (part > 0 && part >= push.colliders))
        return;
    const float margin = find_margin(self, walked, part, push.lanes);
    const float resting = k_resting_margin * cloths[self.cloth].thickness;
    atomicMax(lane_counts[in_group], floatBitsToUint(max(margin, resting)));
    if (margin >= 0)
    {
        atomicMax(widest_margin, floatBitsToUint(margin));
        atomicOr(reaching_vertices, 1);
    }
    if (part > 0)
        return;
    const vec3 velocity = velocities[self.index].xyz;
    feature_centers[self.index] =
        FeatureCenter(positions[self.index].xyz, velocity.x, residuals[self.index], velocity.yz);
}

#endif
