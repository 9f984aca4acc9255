#version 460
#extension GL_GOOGLE_include_directive : require
// Statistics of one patch of vertices: stretch, kinetic energy, values that are not finite, penetration.
//
// A thread measures one vertex: its structural and shear springs (a grid) or edges (a mesh), each once, its energy, and
// its depth under the surface of a collider.
#include "shared/bindings.h"
#include "shared/bvh_layout.h"
#include "shared/cloth_layout.h"
#include "shared/collider_layout.h"
#include "shared/contact_layout.h"
#include "shared/feature_layout.h"
#include "shared/padded_layout.h"
#include "shared/sleep_layout.h"
#include "shared/statistics_layout.h"

layout(local_size_x_id = k_constant_workgroup_size) in;
const uint COLLIDERS_MOVE = 1;

layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
layout(VOILE_BINDING(patches)) readonly buffer Patches { Patch patches[]; };
layout(VOILE_BINDING(positions)) readonly buffer Positions { vec4 positions[]; };
layout(VOILE_BINDING(velocities)) readonly buffer Velocities { vec4 velocities[]; };
layout(VOILE_BINDING(colliders)) readonly buffer Colliders { ColliderRecord colliders[]; };
layout(VOILE_BINDING(bvh_nodes)) readonly buffer BvhNodes { BvhNode bvh_nodes[]; };
layout(VOILE_BINDING(bvh_triangles)) readonly buffer BvhTriangles { BvhTriangle bvh_triangles[]; };
layout(VOILE_BINDING(partials)) writeonly buffer Partials { StatisticsRecord partials[]; };
layout(VOILE_BINDING(mesh_vertices)) readonly buffer MeshVertices { MeshVertex mesh_vertices[]; };
layout(VOILE_BINDING(mesh_springs)) readonly buffer MeshSprings { MeshSpring mesh_springs[]; };
layout(VOILE_BINDING(collider_motions)) readonly buffer ColliderMotions { ColliderMotion collider_motions[]; };
layout(VOILE_BINDING(candidate_triangles)) readonly buffer CandidateTriangles { uint candidate_triangles[]; };
layout(VOILE_BINDING(padded_boxes)) readonly buffer PaddedBoxes { PaddedBox padded_boxes[]; };
layout(VOILE_BINDING(padded_leaves)) readonly buffer PaddedLeaves { PaddedLeaf padded_leaves[]; };
layout(VOILE_BINDING(deforming_positions)) readonly buffer DeformingPositions { vec4 deforming_positions[]; };
layout(VOILE_BINDING(residuals)) readonly buffer Residuals { uvec2 residuals[]; };
layout(VOILE_BINDING(sleeps)) readonly buffer Sleeps { SleepRecord sleeps[]; };
layout(VOILE_BINDING(near_colliders)) readonly buffer NearColliders { uint near_colliders[]; };
layout(VOILE_BINDING(feature_cells)) readonly buffer FeatureCells { FeatureCell cells[]; };

layout(push_constant, std430) uniform Push { StatisticsPush push; };

#include "shared/patch.glsl"
#include "colliders/collider_pose.glsl"
#include "contact/convex.glsl"
#include "shared/fine_position.glsl"
#include "colliders/near_colliders.glsl"
#include "contact/solid_query.glsl"
#include "shared/grid.glsl"
#include "shared/mesh.glsl"
#include "sleep/sleep.glsl"
#include "statistics/statistics_merge.glsl"

bool finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

FinePosition position_of(uint i)
{
    const vec3 x = positions[i].xyz;
    return FinePosition(x, unpack_residual(residuals[i]));
}

void measure_spring(uint self, uint other, float rest_length, inout StatisticsRecord record)
{
    const float stretch = length(displacement(position_of(self), position_of(other))) / rest_length - 1;
    record.max_stretch = max(record.max_stretch, stretch);
    record.stretch_sum += stretch;
    record.springs += 1;
}

void measure_grid_springs(PatchVertex self, inout StatisticsRecord record)
{
    const uint cloth = self.cloth;
    for (int c = 0; c < 4; ++c) // structural and shear
    {
        const SpringClass spring = cloths[cloth].springs[c];
        const ivec2 offset = k_spring_offsets[c];
        if (spring.stiffness > 0 &&
            in_grid(self.column_row + offset, cloths[cloth].columns, cloths[cloth].rows))
            measure_spring(self.index, neighbor(self.index, offset, cloths[cloth].columns), spring.rest_length, record);
    }
}

// An edge is measured by the vertex with the smaller index.
void measure_mesh_springs(uint cloth, uint local, inout StatisticsRecord record)
{
    const uint first = cloths[cloth].first_vertex;
    const MeshVertex vertex = mesh_vertices[cloths[cloth].first_list + local];
    for (uint s = 0; s < vertex.springs; ++s)
    {
        const MeshSpring entry = mesh_springs[vertex.first_spring + s * MESH_STRIDE];
        if (entry.neighbor > local && (entry.neighbor & VOILE_OPPOSITE_BIT) == 0)
            measure_spring(first + local, first + entry.neighbor, entry.rest_length, record);
    }
}

// Whether a point is inside a one-sided mesh, by its winding number; a two-sided mesh has no inside. For a closed mesh
// the number is the sum of the signed crossings of a line, for an open mesh the generalized one. Outside of its box no
// mesh fills half of all directions.
bool is_in_mesh(Solid solid, vec3 point)
{
    if ((solid.collider.flags & VOILE_COLLIDER_ONE_SIDED) == 0 || !in_box(solid.collider, point))
        return false;
    if ((solid.collider.flags & VOILE_COLLIDER_CLOSED) != 0)
        return line_exits(solid, point, 1).winding > 0;
    return generalized_winding(solid, point) > 0.5;
}

// m: the depth of a point in a collider. 0 or less: it is outside.
float depth_in(Solid solid, vec3 point)
{
    const ColliderRecord collider = solid.collider;
    if (collider.kind == VOILE_COLLIDER_PLANE)
        return -plane_surface(collider, point).distance;
    if (collider.kind != VOILE_COLLIDER_MESH)
        return -convex_surface(collider, point).distance;
    return is_in_mesh(solid, point) ? nearest_distance(solid, point, 3e38) : 0;
}

void measure_penetration(FinePosition p, uint layers, inout StatisticsRecord record)
{
    float depth = 0;
    ColliderWalk walk = walk_colliders(gl_WorkGroupID.x, Box(p.x, p.x));
    uint c;
    while (next_collider(walk, c))
    {
        const Solid solid = Solid(c, colliders[c], true);
        if ((solid.collider.layers & layers) != 0)
            depth = max(depth, depth_in(solid, into_collider(c, solid.collider.flags, p, 1)));
    }
    record.deepest_penetration = depth;
    record.penetrating_vertices = depth > 0 ? 1 : 0;
}

// Of the triangles and features near a vertex.
void count_listed(PatchVertex self, inout StatisticsRecord record)
{
    const uint count = candidate_triangles[self.index] & VOILE_CANDIDATE_COUNT_MASK;
    const bool finds_features = push.features != 0 && !is_asleep(self.cloth);
    const bool traverses = finds_features && cells[self.index].invalid == VOILE_EVERY_SUBSTEP;
    record.candidates = min(count, VOILE_CANDIDATES);
    record.overflowing_vertices = count > VOILE_CANDIDATES || traverses ? 1 : 0;
}

void main()
{
    const PatchVertex self = patch_vertex(gl_WorkGroupID.x);
    const uint cloth = self.cloth;
    StatisticsRecord record = no_statistics();
    if (self.exists)
    {
        record.sleeping_cloths = self.local == 0 && is_asleep(cloth) ? 1 : 0;
        const uint i = self.index;
        const vec4 x = positions[i];
        const vec4 v = velocities[i];
        if (!finite(x.xyz) || !finite(v.xyz))
            record.nan_vertices = 1;
        else
        {
            const uint columns = cloths[cloth].columns;
            if (columns > 0)
                measure_grid_springs(self, record);
            else
                measure_mesh_springs(cloth, self.local, record);
            measure_penetration(position_of(i), cloths[cloth].layers, record);
            if (push.colliders > 0)
                count_listed(self, record);
            record.kinetic_energy = x.w > 0 ? 0.5 * dot(v.xyz, v.xyz) / x.w : 0;
            record.contacts = (uint(v.w) & (VOILE_VERTEX_TOUCHES | VOILE_VERTEX_TOUCHES_FEATURE)) != 0 ? 1 : 0;
        }
    }
    const StatisticsRecord merged = merge_workgroup(record);
    if (gl_LocalInvocationID.x == 0)
        partials[gl_WorkGroupID.x] = merged;
}
