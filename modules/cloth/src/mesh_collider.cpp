// Mesh colliders: their hierarchy and record.
#include "model.hpp"

#include "bvh.hpp"
#include "mesh_input.hpp"

namespace cloth
{

Result<ColliderId> Model::add(const MeshCollider& collider)
{
    const auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    const Bvh bvh = build_bvh(mesh.value().positions, mesh.value().triangles);

    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_MESH, collider.layers, collider.friction);
    if (mesh.value().closed)
        record.flags |= VOILE_COLLIDER_CLOSED;
    if (collider.sides == Sides::one || (collider.sides == Sides::automatic && mesh.value().closed))
        record.flags |= VOILE_COLLIDER_ONE_SIDED;
    record.first_node = static_cast<uint32_t>(nodes.size());
    record.first_triangle = static_cast<uint32_t>(triangles.size());
    record.triangles = static_cast<uint32_t>(bvh.triangles.size());
    const shared::BvhNode& root = bvh.nodes[0];
    record.box_min = glm::min(root.left_min, root.right_min);
    record.box_max = glm::max(root.left_max, root.right_max);
    nodes.insert(nodes.end(), bvh.nodes.begin(), bvh.nodes.end());
    triangles.insert(triangles.end(), bvh.triangles.begin(), bvh.triangles.end());
    return append(record, glm::mat4(1));
}

} // namespace cloth
