// Colliders with a formula: validation and records. Meshes are in mesh_collider.cpp.
#include "colliders/collider_model.hpp"
#include "colliders/collider_motion.hpp"
#include "geometry/rounding.hpp"

#include <cmath>

namespace voile
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

// World.
glm::vec3 corner_of(const BoxCollider& box, int corner)
{
    const glm::vec3 local((corner & 1) == 0 ? box.min.x : box.max.x, (corner & 2) == 0 ? box.min.y : box.max.y,
                          (corner & 4) == 0 ? box.min.z : box.max.z);
    return box.transform * glm::vec4(local, 1);
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
    set_record_friction(record, friction);
    return record;
}

void set_record_friction(shared::ColliderRecord& record, const std::optional<Friction>& friction)
{
    record.flags &= ~VOILE_COLLIDER_FRICTION;
    if (friction)
        record.flags |= VOILE_COLLIDER_FRICTION;
    const Friction coefficients = friction.value_or(Friction{});
    record.static_friction = coefficients.static_coefficient;
    record.kinetic_friction = coefficients.kinetic_coefficient;
}

// m: what floats may take from where a collider is. Beyond it has the finer position of those that move.
constexpr double k_most_origin_error = 1e-5;

ColliderId ColliderModels::append(ColliderModel collider)
{
    const glm::dvec3& origin = collider.origin;
    collider.record.origin = rounded(origin);
    if (collider.placement != glm::mat4(1) ||
        glm::distance(origin, glm::dvec3(collider.record.origin)) > k_most_origin_error)
        collider.record.flags |= VOILE_COLLIDER_MOVED;
    return colliders.add(std::move(collider));
}

void ColliderModels::remove(ColliderId id)
{
    const ColliderModel& collider = *colliders.find(id);
    hierarchies.release(collider.hierarchy.get());
    features.release(collider.features.get());
    if (const auto& mesh = collider.deforming)
    {
        padded_leaves.release(collider.record.first_triangle, mesh->leaves.size());
        padded_boxes.release(mesh->first_range, mesh->boxes);
        deforming_positions.release(mesh->first_vertex, 2 * uint64_t{mesh->vertices});
    }
    colliders.remove(id);
}

void set_plane_origin(ColliderModel& plane, const glm::dvec3& point)
{
    shared::ColliderRecord& record = plane.record;
    const glm::dvec3 normal(record.shape);
    const auto offset = static_cast<double>(*plane.plane_offset);
    record.origin = rounded(point - (glm::dot(normal, point) - offset) * normal);
    plane.origin = record.origin;
    record.shape.w = static_cast<float>(offset - glm::dot(normal, glm::dvec3(record.origin)));
}

Result<ColliderId> ColliderModels::add(const PlaneCollider& collider)
{
    if (!finite(collider.normal) || std::abs(glm::length(collider.normal) - 1) > 1e-3f)
        return invalid("collider", collider.name,
                       "the plane's normal " + text(collider.normal) + " is not of unit length");
    Checks checks(collider.name, collider.friction);
    checks.offset("offset", collider.offset);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_PLANE, collider.layers, collider.friction);
    record.shape = glm::vec4(glm::normalize(collider.normal), 0);
    const ColliderId id = append({.record = record, .plane_offset = collider.offset});
    set_plane_origin(*colliders.find(id), glm::dvec3(0));
    return id;
}

Result<ColliderId> ColliderModels::add(const SphereCollider& collider)
{
    Checks checks(collider.name, collider.friction);
    checks.position("center", collider.center);
    checks.size("radius", collider.radius);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_SPHERE, collider.layers, collider.friction);
    record.shape = glm::vec4(glm::vec3(0), collider.radius);
    return append({.record = record, .origin = collider.center});
}

Result<ColliderId> ColliderModels::add(const CapsuleCollider& collider)
{
    Checks checks(collider.name, collider.friction);
    checks.position("from", collider.from);
    checks.position("to", collider.to);
    checks.size("radius", collider.radius);
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_CAPSULE, collider.layers, collider.friction);
    const glm::dvec3 from(collider.from);
    const glm::dvec3 to(collider.to);
    record.shape = glm::dvec4(0.5 * (to - from), collider.radius);
    return append({.record = record, .origin = 0.5 * (from + to)});
}

Result<ColliderId> ColliderModels::add(const BoxCollider& collider)
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
    for (int corner = 0; corner < 8; ++corner)
        checks.position("a corner", corner_of(collider, corner));
    if (!checks.status())
        return checks.status().error();
    auto record = make_collider_record(VOILE_COLLIDER_BOX, collider.layers, collider.friction);
    const glm::dvec3 min(collider.min);
    const glm::dvec3 max(collider.max);
    record.shape = glm::dvec4(0.5 * (max - min), 0);
    return append({.record = record, .origin = 0.5 * (min + max), .placement = collider.transform});
}

} // namespace voile
