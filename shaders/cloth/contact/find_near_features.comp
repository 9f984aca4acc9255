#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Lists the features near the pieces of all cloths, and the patches near features, until the next such pass.
// test_features.comp runs over the listed features, feature_contact.comp over the patches, by indirect dispatches.
//
// The threads of a workgroup gather the features near its vertices (feature_gathering.glsl). Several threads per vertex
// (push.lanes) each take some of its pieces. They test them twice: first they count the features near them, for four
// margins, then they write those within the widest margin with few enough. The features stay in shared memory from one
// test to the other, if they fit, and are gathered again, if not. Then a margin within which a vertex has too many features
// already is left out of what is gathered next. A vertex that has too many within all margins has no items, and
// feature_contact.comp traverses the hierarchies instead.
//
// Which vertices get items depends on no order of workgroups. If there is no room for the items of all, the query is
// repeated with fewer of each vertex, so few that there is.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
layout(constant_id = k_constant_colliders_move) const uint COLLIDERS_MOVE = 1;
layout(constant_id = k_constant_fewer_rounds) const uint FEWER_ROUNDS = 0; // 1: loops of more work per round

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(residuals)) readonly buffer Residuals { uvec2 residuals[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
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
layout(VOILE_BINDING(deforming_reach)) readonly buffer DeformingReach { uint deforming_reach[]; };
layout(VOILE_BINDING(feature_traversals)) buffer FeatureTraversals { uint traversals[]; };
layout(VOILE_BINDING(feature_dispatch)) buffer FeatureDispatch { uint dispatch_size[]; };
layout(VOILE_BINDING(feature_patches)) writeonly buffer FeaturePatches { uint near_patches[]; };
layout(VOILE_BINDING(feature_centers)) writeonly buffer FeatureCenters { FeatureCenter feature_centers[]; };
layout(VOILE_BINDING(feature_cells)) writeonly buffer FeatureCells { FeatureCell cells[]; };
layout(VOILE_BINDING(feature_items)) writeonly buffer FeatureItems { FeatureItem items[]; };
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };

layout(push_constant, std430) uniform Push { NearFeaturesPush push; };

#include "shared/patch.glsl"
#include "shared/mesh.glsl"
#include "shared/segments.glsl"
#include "shared/step_input.glsl"
#include "colliders/collider_pose.glsl"
#include "colliders/near_colliders.glsl"
#include "contact/feature_fan.glsl"
#include "contact/near_feature.glsl"
#include "contact/rounding.glsl"
#include "contact/triangle.glsl"

// Each margin is half of the one before.
const uint k_margins = 4;
const float k_fractions[k_margins] = float[](1, 0.5, 0.25, 0.125);

// For so many colliders several guards share a mesh's cell.
const uint k_most_shared = 2;

shared uint near_vertices; // of the workgroup

// Each patch has as many workgroups as vertices have lanes.
uint patch_of_group() { return push.first_patch + gl_WorkGroupID.x / push.lanes; }

// The space of a collider when features are listed.
struct Space
{
    uint collider;
    uint flags;
    Pose pose;
};

struct PieceKind
{
    uint kind;
    uint k;
};

// Features near a piece of cloth.
struct FeatureSearch
{
    PatchVertex self;
    PieceKind piece;
    Triangle shape;     // an edge repeats its second vertex
    uint collider;
    Box box;            // of the piece, grown by the margin
    float query_radius; // m, the thickness with room for rounding
    bool deforms;       // the collider does, and the cloth is expected to move on, in its space:
    vec3 motion;        // m, of the piece's middle; else 0
    float spread;       // m, of its vertices from that
    float widest;       // m, the margin that is counted with
    float margin;       // m, of features that count yet, or that are written
    uint narrowed;      // margins within which too many are
    bool writes;
    uvec4 counts;       // within each margin
    bool ended;         // no vertex of the workgroup searches on
    uint near;          // one bit per collider that has a feature which may touch a triangle around the vertex
    uint next;          // item to write
    uint end;
};

FinePosition position_of(uint vertex)
{
    return FinePosition(positions[vertex].xyz, unpack_residual(residuals[vertex]));
}

#include "contact/feature_surrounding.glsl"

Space space_at(uint c, float progress)
{
    Space space = Space(c, colliders[c].flags, Pose(vec4(0, 0, 0, 1), vec3(0)));
    if (is_moved(space.flags))
        space.pose = pose_at(c, progress);
    return space;
}

// Of a vertex after `time`, s, at its velocity.
vec3 position_in(Space space, uint vertex, float time)
{
    const vec3 offset = from_origin(space.collider, space.flags, position_of(vertex)) + time * velocities[vertex].xyz;
    return is_moved(space.flags) ? to_collider(space.pose, offset) : offset;
}

// m. `a`: with the feature's radius.
float feature_distance(vec4 a, vec3 b, Triangle t, bool edge)
{
    if (edge)
        return segment_distance(t.a, t.b, a.xyz, b) - a.w;
    return distance(a.xyz, nearest_on_triangle(a.xyz, t.a, t.b, t.c)) - a.w;
}

void write_item(inout FeatureSearch search, uint feature, float excess)
{
    if (search.next >= search.end)
        return;
    const uint excess_bits = packHalf2x16(vec2(0, 0.99 * excess)) & 0xffff0000u;
    items[search.next++] = FeatureItem(search.self.index, feature, search.collider | excess_bits,
                                       search.self.cloth | search.piece.kind << VOILE_ITEM_CLOTH_BITS |
                                           search.piece.k << (VOILE_ITEM_CLOTH_BITS + 2));
}

// `excess`: m, the distance beyond the thickness.
void add_item(inout FeatureSearch search, uint feature, float excess)
{
    if (excess > search.margin)
        return;
    if (search.writes)
        write_item(search, feature, excess);
    else
        search.counts += uvec4(lessThanEqual(vec4(excess), search.widest * vec4(k_fractions[0], k_fractions[1], k_fractions[2], k_fractions[3])));
}

void visit_feature(inout FeatureSearch search, uint f, NearFeature near)
{
    const bool edge = search.piece.kind != VOILE_PIECE_TRIANGLE;
    if ((near.a.xyz != near.b) != edge)
        return;
    float distance_meanwhile = feature_distance(near.a, near.b, search.shape, edge);
    if (search.deforms)
        distance_meanwhile -=
            max(distance(near.motion_a, search.motion), distance(near.motion_b, search.motion)) + search.spread;
    const float excess = distance_meanwhile - search.query_radius;
    add_item(search, f, excess > 0 ? excess : 0); // also if it is not a number
}

const uint k_most_found = 512; // features, in a list
// The features of a list, and, after all lists, the items of each vertex within each margin.
shared uint scratch[k_most_found > k_margins * gl_WorkGroupSize.x ? k_most_found : k_margins * gl_WorkGroupSize.x];

#include "colliders/padded_box.glsl"
#include "contact/feature_gathering.glsl"
#include "contact/feature_room.glsl"
#include "contact/feature_margin.glsl"
#include "contact/listed_pieces.glsl"
#include "contact/feature_bits.glsl"

// Where the pieces of a vertex are, and whether they may touch features of the collider.
struct Whereabouts
{
    GroupBoxes boxes;
    bool near;
};

Whereabouts whereabouts_of(FeatureSearch search, uint c)
{
    Whereabouts result;
    result.near = false;
    if (!search.self.exists)
        return result;
    const Surrounding around = surrounding(search.self, c, colliders[c].flags);
    const float radius = query_radius(search.self, max(abs(around.box.min), abs(around.box.max)));
    const float reach = max(search.widest, max(around.longest, sudden_reach()));
    result.boxes.pieces = grown(search.deforms ? joined(around.box, around.later) : around.cell, radius + search.margin);
    result.boxes.sweep = grown(joined(around.box, around.later), radius + reach);
    result.near = overlap(result.boxes.sweep, feature_box(c));
    return result;
}

// The boxes of the workgroup, with the pieces of only those vertices that search.
GroupBoxes boxes_of_group(Whereabouts own, bool searches, uint lane)
{
    if (!searches)
        own.boxes.pieces = Box(vec3(1e38), vec3(-1e38));
    return joined_of_group(own.near && lane == 0, own.boxes);
}

// The boxes in which a vertex of the workgroup may still have few enough features.
GroupBoxes narrowed_boxes(inout FeatureSearch search, inout bool searches, inout Whereabouts own, uint lane)
{
    const float margin = search.margin;
    search.ended = !narrow(search, searches, lane);
    own.boxes.pieces = grown(own.boxes.pieces, search.margin - margin);
    return boxes_of_group(own, searches, lane);
}

// Finds the features of a chunk near the pieces of this lane. Lanes have pieces that follow each other, so that the order of
// a vertex's items depends on no number of lanes.
void search_chunk(inout FeatureSearch search, Chunk chunk, Space space, uint lane, uint count)
{
    const uint end = (lane + 1) * count / push.lanes;
    for (uint i = lane * count / push.lanes; i < end; ++i)
    {
        if (!select_piece(search, space, i) || !(chunk.all || overlap(search.box, chunk_box())))
            continue;
        ChunkWalk walk = walk_chunk(chunk);
        uint f;
        while (next_feature(walk, chunk, search.box, f))
            visit_feature(search, loaded[f], loaded_feature(f));
    }
}

// Adds the guards of the vertex for the `index`-th collider. With several for each of many colliders there would be no room
// for features.
void add_guards(inout FeatureSearch search, uint lane, uint index)
{
    const bool one = search.self.columns > 0 || corner_count(search.self) == 0 || index >= k_most_shared;
    const uint count = one ? 1 : guard_count(search.self);
    for (uint k = lane; k < count; k += push.lanes)
    {
        search.piece = PieceKind(VOILE_PIECE_GUARD, one ? 0 : k + 1);
        add_item(search, floatBitsToUint(search.margin), 0);
    }
}

// Finds the features of the `index`-th collider near the pieces of this lane. `searches`: the same for all lanes of a
// vertex. All threads of the workgroup call it.
void search_collider(inout FeatureSearch search, inout bool searches, uint c, uint lane, uint index)
{
    const Space space = space_at(c, push.progress_from);
    search.collider = c;
    search.deforms = is_deforming(space.flags);
    const bool kept = search.writes && keeps != 0;
    const FeatureTree tree = feature_tree(c, feature_sets[c], search.deforms);
    Whereabouts own;
    GroupBoxes boxes;
    if (!kept)
    {
        own = whereabouts_of(search, c);
        boxes = boxes_of_group(own, searches, lane);
        if (gl_LocalInvocationID.x == 0)
            sweep_is_near = 0;
    }
    else
        own.near = (search.near & 1u << index) != 0;
    const uint first = first_kept(index);
    Chunk chunk = Chunk(first, kept ? kept_ends[index] : first, true);
    const bool far = !kept && any(greaterThan(boxes.sweep.min, boxes.sweep.max)); // no vertex is near
    Chunks chunks = Chunks(0, false, false, kept || far);
    do
    {
        if (!chunks.ended)
        {
            chunk = next_chunk(chunks, tree, boxes, first);
            find_bits(chunk, own.near && searches, own.boxes.pieces, lane);
        }
        const bool full = search.writes && search.next == search.end;
        search_chunk(search, chunk, space, lane, own.near && searches && !full ? piece_count(search.self) : 0);
        if (!chunks.ended && !search.writes)
            boxes = narrowed_boxes(search, searches, own, lane);
    } while (!chunks.ended && !search.ended);
    if (!search.writes)
        keep(chunk, index);
    if (!kept)
        own.near = own.near && sweep_is_near != 0;
    search.near |= own.near ? 1u << min(index, 31) : 0;
    if (own.near && searches)
        add_guards(search, lane, index);
}

// Finds the features near the pieces of this lane. `walked`: of the workgroup, whose threads all call this.
void search_colliders(inout FeatureSearch search, inout bool searches, Box walked, uint lane)
{
    ColliderWalk walk = walk_colliders(patch_of_group(), walked);
    uint c;
    uint position = 0;
    uint index = 0; // of the colliders that are reached
    while (!search.ended && next_collider(walk, c))
        if (may_touch(c, search.self) && is_reached(position++))
            search_collider(search, searches, c, lane, index++);
}

// The box that the workgroup walks over colliders with. All of its threads call it.
Box box_of_walk(PatchVertex self, uint lane)
{
    Box walked = Box(vec3(0), vec3(0));
    if (push.near_stride == 0) // all colliders are walked over
        return walked;
    if (self.exists)
        walked = walked_box(self);
    return joined_of_group(self.exists && lane == 0, GroupBoxes(walked, walked)).sweep;
}

// Whether the pieces of the vertex can be written as items.
bool has_numbers(PatchVertex self)
{
    return self.cloth >> VOILE_ITEM_CLOTH_BITS == 0 && push.colliders <= 0x10000 &&
           corner_count(self) < (1u << (30 - VOILE_ITEM_CLOTH_BITS));
}

void list_patch()
{
    const uint index = patch_of_group();
    const uint query = counted_substep(push.query);
    if (near_vertices != 0 && atomicExchange(patches[index].near_features, query) != query)
        near_patches[push.first_patch +
                     atomicAdd(dispatch_size[push.dispatch_word + VOILE_DISPATCH_PATCHES], 1)] = index;
}

void main()
{
    const uint thread = gl_LocalInvocationID.x;
    const uint lane = thread % push.lanes;
    const uint in_group = thread / push.lanes;
    if ((patches[patch_of_group()].tile & VOILE_PATCH_ASLEEP) != 0)
        return;
    for (uint i = thread; i < k_most_separations; i += gl_WorkGroupSize.x)
        separations[i] = ordered(3e38);
    lane_counts[thread] = 0;
    if (thread == 0)
    {
        near_vertices = reaching_vertices = widest_margin = items_of_group = fewer_items = fewest_items = first_of_group = 0;
        keeps = 1;
    }

    FeatureSearch search;
    search.self = vertex_of_group(in_group);
    const Box walked = box_of_walk(search.self, lane);
    barrier();
    find_margins(thread, walked);
    barrier();
    if (reaching_vertices == 0)
    {
        if (lane == 0)
            write_cell(search.self, push.first_item, 0, has_numbers(search.self));
        return;
    }

    search.counts = uvec4(0);
    search.narrowed = 0;
    search.near = 0;
    search.deforms = false;
    search.motion = vec3(0);
    search.spread = 0;
    search.widest = uintBitsToFloat(lane_counts[in_group]);
    bool searches = search.self.exists;
    search.margin = search.widest;
    // The same instructions count and write, so that rounding does not decide differently.
    for (uint round = 0; round < 2; ++round)
    {
        search.writes = round == 1;
        search.ended = search.writes && items_of_group == 0;
        search_colliders(search, searches, walked, lane);
        if (search.writes)
            continue;
        if (search.near != 0)
            atomicOr(near_vertices, 1);
        searches = allocate(search, searches && has_numbers(search.self), lane, in_group);
    }
    while (search.next < search.end)
        items[search.next++].vertex = VOILE_NO_VERTEX;
    barrier();
    if (thread == 0)
        list_patch();
}
