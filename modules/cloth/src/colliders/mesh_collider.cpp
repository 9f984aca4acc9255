// Mesh colliders: their hierarchy and record.
#include "colliders/collider_model.hpp"

#include "colliders/bvh_cache.hpp"
#include "colliders/mesh_input.hpp"
#include "colliders/refit.hpp"
#include "geometry/padded_tree.hpp"

#include "shared/contact_layout.h"

#include <algorithm>

namespace voile
{

namespace
{

// m, that a mesh has at most along an axis from its origin.
float extent_of(const shared::ColliderRecord& mesh)
{
    const glm::vec3 extent = glm::max(glm::abs(mesh.box_min), glm::abs(mesh.box_max));
    return std::max({extent.x, extent.y, extent.z});
}

} // namespace

ColliderId ColliderModels::append_deforming(shared::ColliderRecord record, const MeshInput& mesh,
                                            const glm::mat4& transform)
{
    PaddedTree tree = build_padded_tree(mesh.positions, mesh.triangles);
    record.flags |= VOILE_COLLIDER_DEFORMS;
    record.first_node = aligned_first_box(padded_boxes);
    record.first_triangle = static_cast<uint32_t>(padded_leaves);
    record.triangles = tree.triangles;
    record.box_min = record.box_max = mesh.positions[mesh.triangles.front().x];
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            record.box_min = glm::min(record.box_min, mesh.positions[t[corner]]);
            record.box_max = glm::max(record.box_max, mesh.positions[t[corner]]);
        }
    record.extent = extent_of(record);
    const ColliderId id = append({.record = record, .origin = mesh.origin});
    DeformingMesh& added = deforming.emplace_back();
    added.collider = id.index;
    added.vertices = static_cast<uint32_t>(mesh.positions.size());
    added.first_vertex = static_cast<uint32_t>(deforming_positions);
    added.transform = transform;
    for (int half = 0; half < 2; ++half)
        for (const glm::vec3& p : mesh.positions)
            added.positions.emplace_back(p, 0);
    padded_boxes = record.first_node + static_cast<uint32_t>(tree.boxes());
    padded_leaves += tree.leaves.size();
    deforming_positions += added.positions.size();
    added.leaves = std::move(tree.leaves);
    return id;
}

// Of the largest buffer, once the mesh is there too.
uint64_t ColliderModels::bytes_with_deforming(const MeshInput& mesh) const
{
    const uint64_t leaves = uint64_t{1} << padded_levels(static_cast<uint32_t>(mesh.triangles.size()));
    const uint64_t boxes = aligned_first_box(padded_boxes) + 2 * leaves - 1;
    const uint64_t vertices = deforming_positions / 2 + mesh.positions.size();
    return std::max({(padded_leaves + leaves) * sizeof(shared::PaddedLeaf), boxes * sizeof(shared::PaddedBox),
                     vertices * std::max(2 * sizeof(glm::vec4), size_t{k_most_stride})});
}

// A word of contact's lists tells a triangle, or a slot of a padded tree, of which a mesh has less than two a triangle.
constexpr size_t k_most_triangles = size_t{1} << VOILE_CANDIDATE_TRIANGLE_BITS;

Result<ColliderId> ColliderModels::add(const MeshCollider& collider)
{
    if (auto sides = check_enumerator(subject("collider", collider.name), "sides", static_cast<int>(collider.sidedness),
                                      {"automatic", "one", "two"});
        !sides)
        return sides.error();
    const auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    const std::string contents = std::to_string(mesh.value().triangles.size()) + " triangles";
    const uint64_t bytes = collider.deforms ? bytes_with_deforming(mesh.value())
                                            : (triangles + mesh.value().triangles.size()) * sizeof(shared::BvhTriangle);
    // Before the hierarchy is built, which takes long.
    if (auto room = check_room(limits, "collider", collider.name, contents, bytes); !room)
        return room.error();
    const uint64_t groups = (mesh.value().positions.size() + limits.workgroup_size - 1) / limits.workgroup_size;
    if (collider.deforms)
        if (auto dispatch = check_dispatch(limits, "collider", collider.name, "its vertices need", groups); !dispatch)
            return dispatch.error();
    const size_t listed = collider.deforms ? padded_leaves + 2 * mesh.value().triangles.size()
                                           : triangles + mesh.value().triangles.size();
    if (listed > k_most_triangles)
        return invalid("collider", collider.name,
                       contents + ", and the colliders of a solver can have " + std::to_string(k_most_triangles) +
                           " together");
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_MESH, collider.layers, collider.friction);
    if (mesh.value().closed)
        record.flags |= VOILE_COLLIDER_CLOSED;
    if (collider.sidedness == Sidedness::one_sided ||
        (collider.sidedness == Sidedness::automatic && mesh.value().closed))
        record.flags |= VOILE_COLLIDER_ONE_SIDED;
    if (collider.deforms)
        return append_deforming(record, mesh.value(), collider.transform);
    auto hierarchy = bvh_cache().get(mesh.value().positions, mesh.value().triangles);
    const Bvh& bvh = *hierarchy;
    const uint64_t node_bytes = (nodes + bvh.nodes.size()) * sizeof(shared::BvhNode);
    if (auto room = check_room(limits, "collider", collider.name, contents, node_bytes); !room)
        return room.error();
    record.first_node = static_cast<uint32_t>(nodes);
    record.first_triangle = static_cast<uint32_t>(triangles);
    record.triangles = static_cast<uint32_t>(bvh.triangles.size());
    record.nodes = static_cast<uint32_t>(bvh.nodes.size());
    const shared::BvhNode& root = bvh.nodes[0];
    record.box_min = glm::min(root.left_min, root.right_min);
    record.box_max = glm::max(root.left_max, root.right_max);
    record.extent = extent_of(record);
    nodes += bvh.nodes.size();
    triangles += bvh.triangles.size();
    return append({.record = record, .origin = mesh.value().origin, .hierarchy = std::move(hierarchy)});
}

} // namespace voile
