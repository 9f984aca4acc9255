#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Which candidates of vertices (find_candidates.comp) have a primitive near one of the vertex's. Few have: most are
// neighbors in cloth that bends. One thread per candidate of the vertices that have few of them, so that one vertex
// holds up no others. The vertices that have near candidates are listed, in no order, for find_pairs.comp.
#include "shared/bindings.h"
#include "shared/cloth_layout.h"
#include "shared/pair_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(mesh_fans)) readonly buffer MeshFans { MeshFan mesh_fans[]; };
layout(VOILE_BINDING(mesh_wedges)) readonly buffer MeshWedges { MeshWedge mesh_wedges[]; };
layout(VOILE_BINDING(pair_midpoints)) readonly buffer PairMidpoints { vec4 midpoints[]; };
layout(VOILE_BINDING(pair_carries)) readonly buffer PairCarries { uint pair_carries[]; };
layout(VOILE_BINDING(pair_entries)) readonly buffer PairEntries { uint candidate_places[]; };
layout(VOILE_BINDING(pair_references)) buffer PairReferences { uint candidates[]; };
layout(VOILE_BINDING(pair_lists)) buffer PairLists { PairList pair_lists[]; };
layout(VOILE_BINDING(pair_masks)) writeonly buffer PairMasks { uint searching_vertices[]; };
layout(VOILE_BINDING(pair_passes)) buffer PairPasses { PairDispatch pair_passes[]; };

layout(push_constant, std430) uniform Push { PairPush push; };

#include "pairs/reservation.glsl"
#include "pairs/search.glsl"

void insert(inout Search search, uint kind, uvec4 vertices, bool edges, float at) { ++search.count; }

// One pair is enough.
bool goes_on(Search search) { return search.count == 0; }

// The first near candidate of a vertex lists it.
bool sift(uint place, uint vertex)
{
    const PairList list = pair_lists[vertex];
    const uint other = candidates[place];
    Search search = search_of(vertex, list, 0, 1);
    consider_fan(search, fan_of(pair_lists[other].cloth, other));
    if (search.count == 0)
        candidates[place] = other | VOILE_PAIR_FAR_BIT;
    return search.count > 0 &&
           (atomicOr(pair_lists[vertex].mask, VOILE_PAIR_NEAR_BIT) & VOILE_PAIR_NEAR_BIT) == 0;
}

shared uint shared_vertices;

void main()
{
    const uint at = gl_GlobalInvocationID.x;
    if (gl_LocalInvocationID.x == 0)
        shared_vertices = 0;
    barrier();
    bool searches = false;
    uint vertex = 0;
    if (at < pair_passes[VOILE_PAIR_SIFT].entries)
    {
        const uint place = candidate_places[at];
        vertex = place / VOILE_PAIR_CANDIDATES;
        searches = sift(place, vertex);
    }
    const uint place = searches ? atomicAdd(shared_vertices, 1) : 0;
    barrier();
    if (gl_LocalInvocationID.x == 0)
        reserve(shared_vertices, VOILE_PAIR_FIND, push.lanes);
    barrier();
    if (searches)
        searching_vertices[shared_vertices + place] = vertex;
}
