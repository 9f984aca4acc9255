// Colliders with a formula: validation and records. Meshes are in mesh_collider.cpp.
#include "collider_motion.hpp"
#include "model.hpp"

#include <cmath>

namespace cloth
{

namespace
{

Result<void> check_radius(const std::string& name, const std::string& what, float radius)
{
    if (std::isfinite(radius) && radius > 0)
        return {};
    return invalid("collider", name,
                   "the " + what + "'s radius is " + std::to_string(radius) + " m, must be finite and > 0");
}

} // namespace

Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction)
{
    if (!friction)
        return {};
    return check_friction(subject("collider", name), friction->static_coefficient, friction->kinetic_coefficient);
}

shared::ColliderRecord make_collider_record(uint32_t kind, uint32_t layers, const std::optional<Friction>& friction)
{
    shared::ColliderRecord record{};
    record.kind = kind;
    record.layers = layers;
    if (friction)
    {
        record.flags = VOILE_COLLIDER_FRICTION;
        record.static_friction = friction->static_coefficient;
        record.kinetic_friction = friction->kinetic_coefficient;
    }
    return record;
}

ColliderId Model::append(const shared::ColliderRecord& record, const glm::mat4& placement)
{
    colliders.push_back(record);
    placements.push_back(placement);
    if (placement != glm::mat4(1))
        colliders.back().flags |= VOILE_COLLIDER_MOVED;
    return {static_cast<uint32_t>(colliders.size() - 1)};
}

Result<ColliderId> Model::add(const PlaneCollider& collider)
{
    if (!finite(collider.normal) || std::abs(glm::length(collider.normal) - 1) > 1e-3f)
        return invalid("collider", collider.name, "the plane's normal is not of unit length");
    if (!std::isfinite(collider.offset))
        return invalid("collider", collider.name, "the plane's offset is not finite");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    auto record = make_collider_record(VOILE_COLLIDER_PLANE, collider.layers, collider.friction);
    record.shape = glm::vec4(glm::normalize(collider.normal), collider.offset);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const SphereCollider& collider)
{
    if (!finite(collider.center))
        return invalid("collider", collider.name, "the sphere's centre is not finite");
    if (auto radius = check_radius(collider.name, "sphere", collider.radius); !radius)
        return radius.error();
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    auto record = make_collider_record(VOILE_COLLIDER_SPHERE, collider.layers, collider.friction);
    record.shape = glm::vec4(collider.center, collider.radius);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const CapsuleCollider& collider)
{
    if (!finite(collider.from) || !finite(collider.to))
        return invalid("collider", collider.name, "an end of the capsule is not finite");
    if (auto radius = check_radius(collider.name, "capsule", collider.radius); !radius)
        return radius.error();
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    auto record = make_collider_record(VOILE_COLLIDER_CAPSULE, collider.layers, collider.friction);
    record.shape = glm::vec4(collider.from, collider.radius);
    record.second = glm::vec4(collider.to, 0);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const BoxCollider& collider)
{
    if (!finite(collider.min) || !finite(collider.max))
        return invalid("collider", collider.name, "a corner of the box is not finite");
    if (!glm::all(glm::lessThan(collider.min, collider.max)))
        return invalid("collider", collider.name, "the box has a side without length: min must be below max");
    if (!is_rigid(collider.transform))
        return invalid("collider", collider.name, "the box's transform is not rigid");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    auto record = make_collider_record(VOILE_COLLIDER_BOX, collider.layers, collider.friction);
    record.shape = glm::vec4(0.5f * (collider.min + collider.max), 0);
    record.second = glm::vec4(0.5f * (collider.max - collider.min), 0);
    return append(record, collider.transform);
}

} // namespace cloth
