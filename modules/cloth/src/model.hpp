// Model: the host's copy of everything that was added to a solver, in the layout that is uploaded.
#pragma once

#include "cloth/descriptions.hpp"

#include "bvh_layout.h"
#include "cloth_layout.h"

#include <string>
#include <vector>

namespace cloth
{

// How fast a cloth's stiffest vertex can move; decides the number of substeps.
struct StabilityBound
{
    double omega = 0; // 1/s: sqrt(max 2 sum k / m)
    double decay = 0; // 1/s: max (2 sum c + drag) / m
};

struct Model
{
    std::vector<std::string> cloth_names;
    std::vector<shared::ClothRecord> cloths;
    std::vector<StabilityBound> bounds; // one a cloth
    std::vector<glm::vec4> positions;   // at the start; w: inverse mass
    std::vector<glm::vec4> velocities;  // at the start
    std::vector<shared::ColliderRecord> colliders;
    std::vector<shared::BvhNode> nodes;
    std::vector<shared::BvhTriangle> triangles;

    // Append after validating; unchanged on error.
    Result<ClothId> add(const Grid& grid);
    Result<ColliderId> add(const MeshCollider& collider);
    Result<ColliderId> add(const PlaneCollider& collider);
    Result<ColliderId> add(const SphereCollider& collider);
};

// What the validation of cloths and colliders shares.
Error invalid(const std::string& what, const std::string& name, const std::string& reason);
bool finite(const glm::vec3& v);
bool finite(const glm::mat4& m);
Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction);
shared::ColliderRecord make_collider_record(uint32_t kind, const std::optional<Friction>& friction);

// The chunks that cover all cloths with workgroups of `workgroup_size` vertices; none straddles two cloths.
std::vector<shared::Chunk> make_chunks(const Model& model, uint32_t workgroup_size);

} // namespace cloth
