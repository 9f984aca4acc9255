// Mesh colliders: their hierarchy and record.
#include "colliders/collider_model.hpp"

#include "colliders/bvh_cache.hpp"
#include "colliders/cooked_collider.hpp"
#include "colliders/mesh_input.hpp"
#include "colliders/refit.hpp"
#include "geometry/padded_tree.hpp"
#include "geometry/parallel.hpp"
#include "geometry/same_shape.hpp"

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

shared::ColliderRecord mesh_record(const MeshCollider& collider, bool closed)
{
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_MESH, collider.layers, collider.friction);
    if (closed)
        record.flags |= VOILE_COLLIDER_CLOSED;
    if (collider.sidedness == Sidedness::one_sided || (collider.sidedness == Sidedness::automatic && closed))
        record.flags |= VOILE_COLLIDER_ONE_SIDED;
    return record;
}

Result<void> validate_cooked(const MeshCollider& collider)
{
    const auto bad = [&](const std::string& reason) { return invalid("collider", collider.name, reason); };
    if (!collider.positions.empty() || !collider.triangles.empty())
        return bad("it is cooked, so its positions and triangles must be empty");
    if (collider.deforms)
        return bad("it is cooked and cannot deform");
    if (auto affine = check_affine(subject("collider", collider.name), collider.transform); !affine)
        return affine;
    if (!same_shape(collider.cooked.state()->transform, collider.transform))
        return bad("its transform changes the shape that it was cooked in: it may turn and move it");
    return check_friction(collider.name, collider.friction);
}

// Errors: a corner of the box around a cooked mesh that is out of range where it is placed.
Result<void> check_box(const MeshCollider& description, const ColliderModel& collider)
{
    const shared::BvhNode& root = collider.hierarchy->nodes.front();
    const glm::vec3 min = glm::min(root.left_min, root.right_min);
    const glm::vec3 max = glm::max(root.left_max, root.right_max);
    for (int corner = 0; corner < 8; ++corner)
    {
        const glm::bvec3 upper((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec3 point = collider.origin + glm::dvec3(glm::mix(min, max, upper));
        const glm::vec3 world(glm::dmat4(collider.placement) * glm::dvec4(point, 1));
        if (auto range =
                check(subject("collider", description.name), "a corner of its box", world, k_most_coordinate, " m");
            !range)
            return range;
    }
    return {};
}

} // namespace

ColliderId ColliderModels::append_deforming(shared::ColliderRecord record, const MeshInput& mesh,
                                            const glm::mat4& transform)
{
    PaddedTree tree = build_padded_tree(mesh.positions, mesh.triangles);
    DeformingMesh added;
    added.vertices = static_cast<uint32_t>(mesh.positions.size());
    added.first_vertex = static_cast<uint32_t>(deforming_positions.allocate(2 * mesh.positions.size()));
    added.transform = transform;
    added.positions = mesh.positions;
    added.boxes = tree.boxes() + k_box_alignment;
    added.first_range = padded_boxes.allocate(added.boxes);
    added.leaves = std::move(tree.leaves);
    record.flags |= VOILE_COLLIDER_DEFORMS;
    record.first_node = aligned_first_box(static_cast<uint32_t>(added.first_range));
    record.first_triangle = static_cast<uint32_t>(padded_leaves.allocate(added.leaves.size()));
    record.triangles = tree.triangles;
    record.box_min = record.box_max = mesh.positions[mesh.triangles.front().x];
    for (const glm::uvec3& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
        {
            record.box_min = glm::min(record.box_min, mesh.positions[t[corner]]);
            record.box_max = glm::max(record.box_max, mesh.positions[t[corner]]);
        }
    record.extent = extent_of(record);
    return append({.record = record, .origin = mesh.origin, .deforming = std::move(added)});
}

// Of the largest buffer, once the mesh is there too.
uint64_t ColliderModels::bytes_with_deforming(const MeshInput& mesh) const
{
    const uint64_t leaves = uint64_t{1} << padded_levels(static_cast<uint32_t>(mesh.triangles.size()));
    const uint64_t boxes = padded_boxes.end_with(2 * leaves - 1 + k_box_alignment);
    const uint64_t vertices = deforming_positions.end_with(2 * mesh.positions.size()) / 2;
    return std::max({padded_leaves.end_with(leaves) * sizeof(shared::PaddedLeaf), boxes * sizeof(shared::PaddedBox),
                     vertices * std::max(2 * sizeof(glm::vec4), size_t{k_most_stride})});
}

// A word of contact's lists names a triangle, or a slot of a padded tree, which has fewer than two slots per triangle.
constexpr size_t k_most_triangles = size_t{1} << VOILE_CANDIDATE_TRIANGLE_BITS;

// Errors: more triangles than the buffers hold, or than a word of contact's lists can name.
Result<void> ColliderModels::check_triangles(const std::string& name, size_t count, bool deforms) const
{
    const std::string contents = std::to_string(count) + " triangles";
    const uint64_t listed =
        deforms ? padded_leaves.end_with(2 * count) : hierarchies.end_with(k_hierarchy_triangles, count);
    const uint64_t bytes = deforms ? 0 : listed * sizeof(shared::BvhTriangle);
    if (auto room = check_room(limits, "collider", name, contents, bytes); !room)
        return room;
    if (listed > k_most_triangles)
        return invalid("collider", name,
                       contents + ", and the colliders of a solver can have " + std::to_string(k_most_triangles) +
                           " together");
    return {};
}

Result<void> ColliderModels::check_deforming(const std::string& name, const MeshInput& mesh) const
{
    const std::string contents = std::to_string(mesh.triangles.size()) + " triangles";
    if (auto room = check_room(limits, "collider", name, contents, bytes_with_deforming(mesh)); !room)
        return room;
    const uint64_t groups = (mesh.positions.size() + limits.workgroup_size - 1) / limits.workgroup_size;
    return check_dispatch(limits, "collider", name, "its vertices need", groups);
}

Result<ColliderId> ColliderModels::append_rigid(const MeshCollider& description, ColliderModel collider)
{
    const Bvh& bvh = *collider.hierarchy;
    const uint64_t node_bytes = hierarchies.end_with(k_hierarchy_nodes, bvh.nodes.size()) * sizeof(shared::BvhNode);
    if (auto room = check_room(limits, "collider", description.name,
                               std::to_string(bvh.triangles.size()) + " triangles", node_bytes);
        !room)
        return room.error();
    shared::ColliderRecord& record = collider.record;
    const auto& placement = hierarchies.acquire(collider.hierarchy, {bvh.nodes.size(), bvh.triangles.size()});
    record.first_node = static_cast<uint32_t>(placement.first[k_hierarchy_nodes]);
    record.first_triangle = static_cast<uint32_t>(placement.first[k_hierarchy_triangles]);
    record.triangles = static_cast<uint32_t>(bvh.triangles.size());
    record.nodes = static_cast<uint32_t>(bvh.nodes.size());
    const shared::BvhNode& root = bvh.nodes[0];
    record.box_min = glm::min(root.left_min, root.right_min);
    record.box_max = glm::max(root.left_max, root.right_max);
    record.extent = extent_of(record);
    return append(std::move(collider));
}

Result<ColliderId> ColliderModels::add_cooked(const MeshCollider& description)
{
    const CookedCollider::State& cooked = *description.cooked.state();
    if (auto valid = validate_cooked(description); !valid)
        return valid.error();
    if (auto room = check_triangles(description.name, cooked.hierarchy->triangles.size(), false); !room)
        return room.error();
    ColliderModel collider{
        .record = mesh_record(description, cooked.closed), .origin = cooked.origin, .hierarchy = cooked.hierarchy};
    const glm::dmat4 now(description.transform);
    const glm::dmat4 then(cooked.transform);
    if (glm::mat3(description.transform) == glm::mat3(cooked.transform))
        collider.origin += glm::dvec3(now[3] - then[3]);
    else
        collider.placement = now * glm::inverse(then);
    if (auto range = check_box(description, collider); !range)
        return range.error();
    return append_rigid(description, std::move(collider));
}

Result<ColliderId> ColliderModels::add(const MeshCollider& collider)
{
    if (auto sides = check_enumerator(subject("collider", collider.name), "sidedness",
                                      static_cast<int>(collider.sidedness), {"automatic", "one_sided", "two_sided"});
        !sides)
        return sides.error();
    if (collider.cooked)
        return add_cooked(collider);
    const auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    if (collider.deforms)
        if (auto room = check_deforming(collider.name, mesh.value()); !room)
            return room.error();
    // Before the hierarchy is built, which takes long.
    if (auto room = check_triangles(collider.name, mesh.value().triangles.size(), collider.deforms); !room)
        return room.error();
    const shared::ColliderRecord record = mesh_record(collider, mesh.value().closed);
    if (collider.deforms)
        return append_deforming(record, mesh.value(), collider.transform);
    return append_rigid(collider, {.record = record,
                                   .origin = mesh.value().origin,
                                   .hierarchy = bvh_cache().get(mesh.value().positions, mesh.value().triangles)});
}

Result<CookedCollider> cook(const MeshCollider& collider, const Jobs& jobs)
{
    const JobScope scope(jobs);
    if (collider.deforms)
        return invalid("collider", collider.name, "a mesh that deforms cannot be cooked");
    if (collider.cooked)
        return collider.cooked;
    const auto mesh = prepare_mesh(collider);
    if (!mesh)
        return mesh.error();
    return CookedCollider(std::make_shared<const CookedCollider::State>(
        CookedCollider::State{collider.transform, mesh.value().origin, mesh.value().closed,
                              bvh_cache().get(mesh.value().positions, mesh.value().triangles)}));
}

} // namespace voile
