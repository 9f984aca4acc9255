// Model: what the validation of all input shares, and analytic colliders. Cloths are in cloth_model.cpp, grid_cloth.cpp
// and mesh_cloth.cpp, mesh colliders in mesh_collider.cpp.
#include "model.hpp"

#include <cmath>
#include <cstddef>

namespace cloth
{

// What std430 makes of the shared structs, checked by spirv-val on its side.
static_assert(sizeof(shared::SpringClass) == 16);
static_assert(sizeof(shared::ClothRecord) == 96 + 16 * VOILE_SPRING_CLASSES);
static_assert(offsetof(shared::ClothRecord, bending) == 80);
static_assert(offsetof(shared::ClothRecord, springs) == 96);
static_assert(sizeof(shared::MeshVertex) == 16);
static_assert(sizeof(shared::MeshSpring) == 16);
static_assert(sizeof(shared::MeshCorner) == 8);
static_assert(sizeof(shared::Chunk) == 16);
static_assert(sizeof(shared::ColliderRecord) == 80);
static_assert(offsetof(shared::ColliderRecord, shape) == 64);
static_assert(sizeof(shared::StagePush) == 68);
static_assert(offsetof(shared::StagePush, gust_phases) == 32);
static_assert(sizeof(shared::StatisticsRecord) == 48);

namespace
{

ColliderId append(std::vector<shared::ColliderRecord>& colliders, const shared::ColliderRecord& record)
{
    colliders.push_back(record);
    return {static_cast<uint32_t>(colliders.size() - 1)};
}

} // namespace

Error invalid(const std::string& what, const std::string& name, const std::string& reason)
{
    return Error{what + " \"" + name + "\": " + reason};
}

bool finite(const glm::vec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const glm::mat4& m)
{
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row]))
                return false;
    return true;
}

Result<void> check_friction(const std::string& name, const std::optional<Friction>& friction)
{
    if (!friction)
        return {};
    const float s = friction->static_coefficient;
    const float k = friction->kinetic_coefficient;
    if (!std::isfinite(s) || !std::isfinite(k) || k < 0 || s < k)
        return invalid("collider", name,
                       "friction " + std::to_string(s) + " static, " + std::to_string(k) +
                           " kinetic; needs static >= kinetic >= 0");
    return {};
}

shared::ColliderRecord make_collider_record(uint32_t kind, const std::optional<Friction>& friction)
{
    shared::ColliderRecord record{};
    record.kind = kind;
    if (friction)
    {
        record.flags = VOILE_COLLIDER_FRICTION;
        record.static_friction = friction->static_coefficient;
        record.kinetic_friction = friction->kinetic_coefficient;
    }
    return record;
}

Result<ColliderId> Model::add(const PlaneCollider& collider)
{
    if (!finite(collider.normal) || std::abs(glm::length(collider.normal) - 1) > 1e-3f)
        return invalid("collider", collider.name, "the plane's normal is not of unit length");
    if (!std::isfinite(collider.offset))
        return invalid("collider", collider.name, "the plane's offset is not finite");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_PLANE, collider.friction);
    record.shape = glm::vec4(glm::normalize(collider.normal), collider.offset);
    return append(colliders, record);
}

Result<ColliderId> Model::add(const SphereCollider& collider)
{
    if (!finite(collider.center))
        return invalid("collider", collider.name, "the sphere's centre is not finite");
    if (!std::isfinite(collider.radius) || collider.radius <= 0)
        return invalid("collider", collider.name,
                       "the sphere's radius is " + std::to_string(collider.radius) + " m, must be finite and > 0");
    if (auto friction = check_friction(collider.name, collider.friction); !friction)
        return friction.error();
    shared::ColliderRecord record = make_collider_record(VOILE_COLLIDER_SPHERE, collider.friction);
    record.shape = glm::vec4(collider.center, collider.radius);
    return append(colliders, record);
}

} // namespace cloth
