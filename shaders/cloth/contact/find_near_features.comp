#version 460
#extension GL_GOOGLE_include_directive : require
// Lists the features near the triangles of all cloths, and the patches near features, until the next such pass.
// feature_contact.comp runs over these patches only, by an indirect dispatch. One thread per vertex: it makes the lists
// of the triangles of its cell of a grid, or of those around a vertex of a mesh.
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
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_corners)) readonly buffer MeshCorners { MeshCorner mesh_corners[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(feature_sets)) readonly buffer FeatureSets { FeatureSet feature_sets[]; };
layout(VOILE_BINDING(feature_nodes)) readonly buffer FeatureNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(features)) readonly buffer Features { Feature features[]; };
layout(VOILE_BINDING(feature_dispatch)) buffer FeatureDispatch { uint dispatch_size[]; };
layout(VOILE_BINDING(feature_patches)) writeonly buffer FeaturePatches { uint near_patches[]; };
layout(VOILE_BINDING(feature_centers)) writeonly buffer FeatureCenters { vec4 feature_centers[]; };
layout(VOILE_BINDING(feature_lists)) buffer FeatureLists { uint feature_lists[]; };
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };

layout(push_constant, std430) uniform Push { NearFeaturesPush push; };

#include "shared/patch.glsl"
#include "shared/mesh.glsl"
#include "shared/segments.glsl"
#include "colliders/collider_pose.glsl"
#include "colliders/near_colliders.glsl"
#include "contact/feature_fan.glsl"
#include "contact/feature_lists.glsl"
#include "contact/rounding.glsl"
#include "contact/triangle.glsl"

// The margin of cloth at rest, as a fraction of the thickness.
const float k_resting_margin = 0.5;
// Of moving cloth, as a fraction of the displacement that it will have at its velocity.
const float k_moving_margin = 1.25;
// A full list halves its margin at most this often.
const uint k_most_halvings = 5;

shared uint near_vertices;

// The space of a collider when the lists are made.
struct Space
{
    uint collider;
    uint flags;
    Pose pose;
};

// The vertices of a grid's cell: the two triangles are 0, 1, 3 and 1, 2, 3.
const ivec2 k_cell[4] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));

// Features near the triangles of both lists.
struct FeatureSearch
{
    PatchVertex self;
    Space space;
    Box box;         // of the triangles, grown by the margin
    Box sweep;       // of all triangles around the vertex until the next pass
    bool found;      // a feature in the sweep
    float query_radius; // m, the thickness with room for rounding
    FeatureList lists[VOILE_FEATURE_LISTS];
};

// The first leaf in the sweep suffices.
bool enters_node(FeatureSearch search, Box node)
{
    return overlap(search.box, node) || (!search.found && overlap(search.sweep, node));
}

// The residual is far smaller than margins.
vec3 position_in(Space space, uint vertex)
{
    const vec3 offset = from_origin(space.collider, space.flags, FinePosition(positions[vertex].xyz, vec3(0)));
    return is_moved(space.flags) ? to_collider(space.pose, offset) : offset;
}

// The number of triangles of a list.
uint triangle_count(PatchVertex self, uint list)
{
    if (self.columns > 0)
        return in_grid(self.column_row + ivec2(1), self.columns, self.rows) ? 1 : 0;
    return (corner_count(self) + VOILE_FEATURE_LISTS - 1 - list) / VOILE_FEATURE_LISTS;
}

uvec3 triangle_vertices(PatchVertex self, uint list, uint i)
{
    if (self.columns == 0)
    {
        uint b;
        uint c;
        find_corner(self, i * VOILE_FEATURE_LISTS + list, b, c);
        return uvec3(self.index, b, c);
    }
    return uvec3(neighbor(self.index, k_cell[list], self.columns), neighbor(self.index, k_cell[list + 1], self.columns),
                 neighbor(self.index, k_cell[3], self.columns));
}

// m, between the feature and the triangle; of a feature edge the triangle's edges count.
float feature_distance(Feature feature, Triangle t)
{
    if (feature.a == feature.b)
        return distance(feature.a, nearest_on_triangle(feature.a, t.a, t.b, t.c)) - feature.radius;
    return min(min(segment_distance(t.a, t.b, feature.a, feature.b), segment_distance(t.b, t.c, feature.a, feature.b)),
               segment_distance(t.c, t.a, feature.a, feature.b)) -
           feature.radius;
}

float list_distance(FeatureSearch search, uint list, Feature feature)
{
    float least = 3e38;
    const uint count = triangle_count(search.self, list);
    for (uint i = 0; i < count; ++i)
    {
        const uvec3 v = triangle_vertices(search.self, list, i);
        const Triangle t = Triangle(position_in(search.space, v.x), position_in(search.space, v.y),
                                    position_in(search.space, v.z));
        least = min(least, feature_distance(feature, t));
    }
    return least;
}

// Halves the margin until a full list has room.
void shrink(inout FeatureList near, uint list)
{
    for (uint halvings = 0; halvings < k_most_halvings && near.count >= VOILE_FEATURE_ENTRIES; ++halvings)
    {
        near.margin *= 0.5;
        uint kept = 0;
        for (uint i = 0; i < near.count; ++i)
        {
            const uint entry = feature_lists[entry_word(list, i)];
            const uint level = entry >> k_feature_bits;
            if (level < k_feature_levels / 2)
                feature_lists[entry_word(list, kept++)] = level << (k_feature_bits + 1) | feature_of(entry);
        }
        near.count = kept;
    }
}

void add_feature(inout FeatureList near, uint list, uint feature, float excess)
{
    if (near.count > VOILE_FEATURE_ENTRIES || excess > near.margin)
        return;
    if (near.count == VOILE_FEATURE_ENTRIES)
        shrink(near, list);
    if (excess > near.margin)
        return;
    const uint level = uint(clamp(excess / near.margin * k_feature_levels, 0, k_feature_levels - 1));
    if (near.count < VOILE_FEATURE_ENTRIES && feature >> k_feature_bits == 0)
        feature_lists[entry_word(list, near.count)] = level << k_feature_bits | feature;
    else
        near.count = VOILE_FEATURE_ENTRIES;
    ++near.count;
}

void visit_leaf(inout FeatureSearch search, uint first, uint count)
{
    search.found = true;
    for (uint f = first; f < first + count; ++f)
    {
        const Feature feature = features[f];
        if (!overlap(search.box, grown(box_around(feature.a, feature.b), feature.radius)))
            continue;
        for (uint t = 0; t < VOILE_FEATURE_LISTS; ++t)
            add_feature(search.lists[t], VOILE_FEATURE_LISTS * search.self.index + t, f,
                        list_distance(search, t, feature) - search.query_radius);
    }
}

#define VOILE_QUERY FeatureSearch
#include "colliders/bvh.glsl"

// The vertices of the triangles around a vertex, and of its cell.
uint around_count(PatchVertex self) { return self.columns > 0 ? 8 : 1 + 2 * corner_count(self); }

// False: outside of the grid.
bool find_around(PatchVertex self, uint i, out uint vertex)
{
    vertex = self.index;
    if (self.columns > 0)
    {
        const ivec2 to = i == 0 ? ivec2(0) : i == 7 ? ivec2(1) : k_ring[i - 1];
        vertex = neighbor(self.index, to, self.columns);
        return in_grid(self.column_row + to, self.columns, self.rows);
    }
    uint other;
    if (i > 0 && i % 2 == 1)
        find_corner(self, (i - 1) / 2, vertex, other);
    else if (i > 0)
        find_corner(self, (i - 1) / 2, other, vertex);
    return true;
}

// The triangles around a vertex in the space of a collider.
struct Surrounding
{
    Box box;       // now
    Box later;     // at the next pass, where the velocities lead
    float longest; // m, the longest displacement of a vertex
};

Surrounding surrounding(PatchVertex self, uint c, uint flags)
{
    Surrounding result = Surrounding(Box(vec3(3e38), vec3(-3e38)), Box(vec3(3e38), vec3(-3e38)), 0);
    const bool moves = is_moved(flags);
    Pose start;
    Pose end;
    if (moves)
    {
        start = pose_at(c, push.progress_from);
        end = pose_at(c, push.progress_to);
    }
    const uint count = around_count(self);
    for (uint i = 0; i < count; ++i)
    {
        uint vertex;
        if (!find_around(self, i, vertex))
            continue;
        vec3 from = from_origin(c, flags, FinePosition(positions[vertex].xyz, vec3(0)));
        vec3 to = from + push.time * velocities[vertex].xyz;
        if (moves)
        {
            from = to_collider(start, from);
            to = to_collider(end, to);
        }
        result.box = joined(result.box, Box(from, from));
        result.later = joined(result.later, Box(to, to));
        result.longest = max(result.longest, distance(from, to));
    }
    return result;
}

// Adds the features of collider c to the lists. Returns whether one may touch the triangles before the next pass.
bool find_features(inout FeatureSearch search, uint c, Surrounding around)
{
    const FeatureSet set = feature_sets[c];
    const float room = max(around.longest, push.sudden * push.time) + search.query_radius;
    search.sweep = grown(joined(around.box, around.later), room);
    search.box = grown(around.box, search.query_radius + max(search.lists[0].margin, search.lists[1].margin));
    search.found = false;
    if (overlap(search.sweep, Box(set.box_min, set.box_max)) || overlap(search.box, Box(set.box_min, set.box_max)))
        traverse_bvh(search, set.first_node, set.first_feature);
    return search.found;
}

bool may_touch(uint c, PatchVertex self)
{
    return feature_sets[c].features > 0 && (colliders[c].layers & cloths[self.cloth].layers) != 0;
}

// m: the margin of the lists of the vertex, for the collider relative to which it moves fastest.
float find_margin(PatchVertex self, Box walked)
{
    float longest = 0;
    ColliderWalk walk = walk_colliders(push.first_patch + gl_WorkGroupID.x, walked);
    uint c;
    while (next_collider(walk, c))
        if (may_touch(c, self))
            longest = max(longest, surrounding(self, c, colliders[c].flags).longest);
    return k_resting_margin * cloths[self.cloth].thickness + k_moving_margin * longest;
}

// Makes the lists of the vertex. Returns whether a feature may touch the triangles around it before the next pass.
bool make_lists(PatchVertex self)
{
    const vec3 position = positions[self.index].xyz;
    const float reach = max(2 * length(velocities[self.index].xyz), push.sudden) * push.time;
    const Box walked = grown(Box(position, position), reach);
    FeatureSearch search;
    search.self = self;
    const float margin = find_margin(self, walked);
    for (uint t = 0; t < VOILE_FEATURE_LISTS; ++t)
        search.lists[t] = FeatureList(margin, 0);
    bool near = false;
    ColliderWalk walk = walk_colliders(push.first_patch + gl_WorkGroupID.x, walked);
    uint c;
    while (next_collider(walk, c))
    {
        if (!may_touch(c, self))
            continue;
        search.space.collider = c;
        search.space.flags = colliders[c].flags;
        if (is_moved(search.space.flags))
            search.space.pose = pose_at(c, push.progress_from);
        const Surrounding around = surrounding(self, c, search.space.flags);
        search.query_radius = 1.01 * cloths[self.cloth].thickness + rounding(max(abs(around.box.min), abs(around.box.max)));
        near = find_features(search, c, around) || near;
    }
    for (uint t = 0; t < VOILE_FEATURE_LISTS; ++t)
        feature_lists[head_word(VOILE_FEATURE_LISTS * self.index + t)] = packed(search.lists[t]);
    feature_centers[self.index] = vec4(position, 0);
    return near;
}

void main()
{
    if (gl_LocalInvocationID.x == 0)
        near_vertices = 0;
    barrier();
    const PatchVertex self = patch_vertex(push.first_patch + gl_WorkGroupID.x);
    if (self.exists && make_lists(self))
        atomicOr(near_vertices, 1);
    barrier();
    if (gl_LocalInvocationID.x > 0)
        return;
    patches[push.first_patch + gl_WorkGroupID.x].near_features = near_vertices;
    if (near_vertices != 0)
        near_patches[push.first_patch + atomicAdd(dispatch_size[push.dispatch_word], 1)] =
            push.first_patch + gl_WorkGroupID.x;
}
