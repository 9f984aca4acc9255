// Mesh colliders: their hierarchy and record.
#include "model.hpp"

#include "bvh_cache.hpp"
#include "mesh_input.hpp"
#include "padded_tree.hpp"
#include "refit.hpp"

namespace cloth
{

ColliderId Model::append_deforming(shared::ColliderRecord record, const MeshInput& mesh, const glm::mat4& transform)
{
    const PaddedTree tree = build_padded_tree(mesh.positions, mesh.triangles);
    record.flags |= VOILE_COLLIDER_DEFORMS;
    record.first_node = aligned_first_box(padded_boxes);
    record.first_triangle = static_cast<uint32_t>(padded_leaves.size());
    record.triangles = tree.triangles;
    record.box_min = record.box_max = mesh.positions.front();
    for (const glm::vec3& p : mesh.positions)
    {
        record.box_min = glm::min(record.box_min, p);
        record.box_max = glm::max(record.box_max, p);
    }
    padded_boxes = record.first_node + static_cast<uint32_t>(tree.boxes());
    padded_leaves.insert(padded_leaves.end(), tree.leaves.begin(), tree.leaves.end());
    const ColliderId id = append(record, glm::mat4(1));
    deforming.push_back({id.index, static_cast<uint32_t>(mesh.positions.size()),
                         static_cast<uint32_t>(deforming_positions.size()), transform});
    for (int half = 0; half < 2; ++half)
        for (const glm::vec3& p : mesh.positions)
            deforming_positions.emplace_back(p, 0);
    return id;
}

Result<ColliderId> Model::add(const MeshCollider& collider)
{
    const auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_MESH, collider.layers, collider.friction);
    if (mesh.value().closed)
        record.flags |= VOILE_COLLIDER_CLOSED;
    if (collider.sides == Sides::one || (collider.sides == Sides::automatic && mesh.value().closed))
        record.flags |= VOILE_COLLIDER_ONE_SIDED;
    if (collider.deforms)
        return append_deforming(record, mesh.value(), collider.transform);
    const auto hierarchy = bvh_cache().get(mesh.value().positions, mesh.value().triangles);
    const Bvh& bvh = *hierarchy;
    record.first_node = static_cast<uint32_t>(nodes.size());
    record.first_triangle = static_cast<uint32_t>(triangles.size());
    record.triangles = static_cast<uint32_t>(bvh.triangles.size());
    record.nodes = static_cast<uint32_t>(bvh.nodes.size());
    const shared::BvhNode& root = bvh.nodes[0];
    record.box_min = glm::min(root.left_min, root.right_min);
    record.box_max = glm::max(root.left_max, root.right_max);
    nodes.insert(nodes.end(), bvh.nodes.begin(), bvh.nodes.end());
    triangles.insert(triangles.end(), bvh.triangles.begin(), bvh.triangles.end());
    return append(record, glm::mat4(1));
}

} // namespace cloth
