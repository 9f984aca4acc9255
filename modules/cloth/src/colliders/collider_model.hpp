// Colliders on the host, each with arrays of its own in the layout that is uploaded.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/solver.hpp"

#include "colliders/collider_features.hpp"
#include "geometry/bvh.hpp"
#include "model/device_limits.hpp"
#include "model/range_allocator.hpp"
#include "model/shared_ranges.hpp"
#include "model/slots.hpp"
#include "shared/collider_layout.h"
#include "shared/padded_layout.h"

#include <memory>
#include <optional>
#include <vector>

namespace voile
{

struct MeshInput; // mesh_input.hpp

// From where a collider was added to where it is.
struct ColliderPose
{
    glm::mat4 from{1.f};              // at the end of the last step
    glm::mat4 to{1.f};                // at the end of the next one
    bool jumped = false;              // to where it is
    std::optional<AnchorId> anchor{}; // of the attachments on its surface
};

// A mesh whose vertices the host moves.
struct DeformingMesh
{
    uint32_t vertices = 0;
    uint32_t first_vertex = 0;        // in the buffer of positions; as many again follow them
    glm::mat4 transform{1.f};         // world from the mesh's space
    std::vector<glm::vec3> positions; // m, as they were added
    std::vector<shared::PaddedLeaf> leaves;
    uint64_t first_range = 0; // of its boxes, with the room for their alignment
    uint64_t boxes = 0;       // with the same room

    uint32_t now = 0;                     // the half of its positions that holds them at the end of the last step
    bool due = false;                     // the host gave new vertices: the next step moves to them, in the other half
    bool refit_due = false;               // its boxes do not fit: after it came to rest
    std::vector<glm::vec3> input;         // given by the host, m
    float farthest = 0;                   // m, how far a vertex moves to there; 0 if they lie on the GPU
    std::optional<DeviceVertices> source; // or where they lie on the GPU

    [[nodiscard]] uint32_t first(uint32_t half) const { return first_vertex + half * vertices; }
    // The halves at the start and at the end of the step.
    [[nodiscard]] uint32_t next() const { return due ? 1 - now : now; }
    [[nodiscard]] uint32_t first_from() const { return first(now); }
    [[nodiscard]] uint32_t first_to() const { return first(next()); }
};

// Bytes from one vertex to the next in what the host gives for a deforming mesh, at most.
constexpr uint32_t k_most_stride = 64;

// Offsets in `record` (first_node, first_triangle) are those of the solver's buffers. They stay as long as the
// collider.
struct ColliderModel
{
    shared::ColliderRecord record{};
    glm::dvec3 origin{0.0};                 // m, before the placement; the record is relative to it
    glm::mat4 placement{1.f};               // the world when it was added; of a box from its space
    std::optional<float> plane_offset{};    // m, of a plane as it was added: normal . x = offset
    std::shared_ptr<const Bvh> hierarchy{}; // of a mesh that keeps its shape; colliders of the same mesh share it
    std::optional<DeformingMesh> deforming{};
    std::shared_ptr<const ColliderFeatures> features{}; // with ranges of the solver's buffers
    bool features_due = false;                          // its shape or its layers changed since they were found
    bool features_new = false;                          // found since the last upload
    ColliderPose pose{};
    bool enabled = true;
    bool uploaded = false; // its arrays are in the solver's buffers
};

// Whether cloth collides with it.
inline bool is_active(const ColliderModel& collider)
{
    return collider.uploaded && collider.enabled;
}

// The record as kernels see it: no cloth collides with a disabled collider.
inline shared::ColliderRecord shown_record(const ColliderModel& collider)
{
    shared::ColliderRecord record = collider.record;
    if (!collider.enabled)
        record.layers = 0;
    return record;
}

// The arrays that have ranges of their own.
enum HierarchyArray : size_t
{
    k_hierarchy_nodes,
    k_hierarchy_triangles,
    k_hierarchy_arrays
};
enum FeatureArray : size_t
{
    k_feature_nodes,
    k_feature_list,
    k_feature_sources, // from here on: of a mesh that deforms
    k_feature_hinges,
    k_feature_slots,
    k_feature_facings, // two per source
    k_feature_arrays
};

// All colliders of a solver. Each has ranges of the solver's buffers for its arrays.
struct ColliderModels
{
    Slots<ColliderId, ColliderModel> colliders;
    SharedRanges<Bvh, k_hierarchy_arrays> hierarchies;
    SharedRanges<ColliderFeatures, k_feature_arrays> features;
    RangeAllocator padded_leaves; // of all meshes that deform
    RangeAllocator padded_boxes;
    RangeAllocator deforming_positions; // two per vertex
    DeviceLimits limits;

    // Validate and add; unchanged on error.
    Result<ColliderId> add(const MeshCollider& collider);
    Result<ColliderId> add(const PlaneCollider& collider);
    Result<ColliderId> add(const SphereCollider& collider);
    Result<ColliderId> add(const CapsuleCollider& collider);
    Result<ColliderId> add(const BoxCollider& collider);
    // Requires that the collider exists.
    void remove(ColliderId collider);

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
void set_plane_origin(ColliderModel& plane, const glm::dvec3& point);

// Friction of its own, or none.
void set_record_friction(shared::ColliderRecord& record, const std::optional<Friction>& friction);

// For all kinds of collider.
Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction);
shared::ColliderRecord make_collider_record(uint32_t kind, uint32_t layers, const std::optional<Friction>& friction);

} // namespace voile
