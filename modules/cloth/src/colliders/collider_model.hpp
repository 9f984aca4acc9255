// Colliders as the solver remembers them, each with arrays of its own in the layout that is uploaded.
#pragma once

#include "voile/descriptions.hpp"

#include "colliders/collider_features.hpp"
#include "geometry/bvh.hpp"
#include "model/device_limits.hpp"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"

#include <memory>
#include <optional>
#include <vector>

namespace voile
{

struct MeshInput; // mesh_input.hpp

// A mesh collider whose vertices the host moves.
struct DeformingMesh
{
    uint32_t collider = 0;
    uint32_t vertices = 0;
    uint32_t first_vertex = 0;        // in the buffer of positions; as many again follow them
    glm::mat4 transform{1.f};         // world from the mesh's space
    std::vector<glm::vec4> positions; // as they were added. Empty once they are uploaded
    std::vector<shared::PaddedLeaf> leaves;

    [[nodiscard]] uint32_t first(uint32_t half) const { return first_vertex + half * vertices; }
};

// Bytes from one vertex to the next in what the host gives for a deforming mesh, at most.
constexpr uint32_t k_most_stride = 64;

// Offsets in `record` (first_node, first_triangle) are those of the solver's buffers, in the order of the colliders.
struct ColliderModel
{
    shared::ColliderRecord record{};
    glm::dvec3 origin{0.0};                 // m, before the placement: the record is told from there
    glm::mat4 placement{1.f};               // the world when it was added; of a box from its space
    std::optional<float> plane_offset{};    // m, of a plane as it was added: normal . x = offset
    std::shared_ptr<const Bvh> hierarchy{}; // of a mesh that keeps its shape; colliders of the same mesh share it
    std::shared_ptr<const ColliderFeatures> features{}; // as they were uploaded last
};

// All colliders of a solver. An upload puts their arrays together.
struct ColliderModels
{
    std::vector<ColliderModel> colliders;
    std::vector<DeformingMesh> deforming; // in the order of their colliders
    uint64_t nodes = 0;                   // of all hierarchies
    uint64_t triangles = 0;               // likewise
    uint64_t padded_leaves = 0;           // of all meshes that deform
    uint32_t padded_boxes = 0;            // likewise, with the room before each tree
    uint64_t deforming_positions = 0;     // likewise, two a vertex
    DeviceLimits limits;

    // Append after validating; unchanged on error.
    Result<ColliderId> add(const MeshCollider& collider);
    Result<ColliderId> add(const PlaneCollider& collider);
    Result<ColliderId> add(const SphereCollider& collider);
    Result<ColliderId> add(const CapsuleCollider& collider);
    Result<ColliderId> add(const BoxCollider& collider);

private:
    Result<ColliderId> add_cooked(const MeshCollider& collider);
    [[nodiscard]] Result<void> check_triangles(const std::string& name, size_t count, bool deforms) const;
    [[nodiscard]] Result<void> check_deforming(const std::string& name, const MeshInput& mesh) const;
    ColliderId append(ColliderModel collider);
    Result<ColliderId> append_rigid(const MeshCollider& description, ColliderModel collider);
    ColliderId append_deforming(shared::ColliderRecord record, const MeshInput& mesh, const glm::mat4& transform);
    [[nodiscard]] uint64_t bytes_with_deforming(const MeshInput& mesh) const;
};

// Puts the origin of a plane where it is nearest to `point`, m, both before its placement.
void place_plane(ColliderModel& plane, const glm::dvec3& point);

// What the validation of colliders shares.
Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction);
shared::ColliderRecord make_collider_record(uint32_t kind, uint32_t layers, const std::optional<Friction>& friction);

} // namespace voile
