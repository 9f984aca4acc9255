// Colliders with a formula: validation and records. Meshes are in mesh_collider.cpp.
#include "collider_motion.hpp"
#include "model.hpp"

#include <cmath>

namespace cloth
{

namespace
{

// What all of them have: positions within the world, sizes, friction.
class Checks
{
public:
    Checks(const std::string& name, const std::optional<Friction>& friction) : what_(subject("collider", name))
    {
        status_ = check_friction(name, friction);
    }

    void position(const char* name, const glm::vec3& value)
    {
        keep(check(what_, name, value, k_most_coordinate, " m"));
    }
    void offset(const char* name, float value)
    {
        keep(check(what_, {name, value, -k_most_coordinate, k_most_coordinate, " m"}));
    }
    void size(const char* name, float value)
    {
        keep(check(what_, {name, value, k_least_collider_size, k_most_collider_size, " m"}));
    }

    void keep(Result<void> result)
    {
        if (status_)
            status_ = std::move(result);
    }
    [[nodiscard]] const Result<void>& status() const { return status_; }

private:
    std::string what_;
    Result<void> status_;
};

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
    Checks checks(collider.name, collider.friction);
    checks.offset("offset", collider.offset);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_PLANE, collider.layers, collider.friction);
    record.shape = glm::vec4(glm::normalize(collider.normal), collider.offset);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const SphereCollider& collider)
{
    Checks checks(collider.name, collider.friction);
    checks.position("center", collider.center);
    checks.size("radius", collider.radius);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_SPHERE, collider.layers, collider.friction);
    record.shape = glm::vec4(collider.center, collider.radius);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const CapsuleCollider& collider)
{
    Checks checks(collider.name, collider.friction);
    checks.position("from", collider.from);
    checks.position("to", collider.to);
    checks.size("radius", collider.radius);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_CAPSULE, collider.layers, collider.friction);
    record.shape = glm::vec4(collider.from, collider.radius);
    record.second = glm::vec4(collider.to, 0);
    return append(record, glm::mat4(1));
}

Result<ColliderId> Model::add(const BoxCollider& collider)
{
    if (!is_rigid(collider.transform))
        return invalid("collider", collider.name, "the box's transform is not rigid");
    Checks checks(collider.name, collider.friction);
    checks.position("min", collider.min);
    checks.position("max", collider.max);
    const glm::vec3 sides = collider.max - collider.min;
    checks.size("the side along x", sides.x);
    checks.size("the side along y", sides.y);
    checks.size("the side along z", sides.z);
    checks.position("its center", glm::vec3(collider.transform * glm::vec4(0.5f * (collider.min + collider.max), 1)));
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_BOX, collider.layers, collider.friction);
    record.shape = glm::vec4(0.5f * (collider.min + collider.max), 0);
    record.second = glm::vec4(0.5f * (collider.max - collider.min), 0);
    return append(record, collider.transform);
}

} // namespace cloth
