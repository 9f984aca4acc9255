// Changes of colliders by the host: moves, friction, radius, layers, and attachments to their surfaces.
#include "geometry/bvh_query.hpp"
#include "solver/solver_state.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace voile
{

namespace
{

// The point of a collider's surface nearest to x, both in the collider's space, as in its record.
using FindSurface = std::function<std::optional<glm::dvec3>(const glm::dvec3& x)>;

glm::dvec3 nearest_on_segment(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& x)
{
    const glm::dvec3 axis = b - a;
    const double t = glm::dot(x - a, axis) / std::max(glm::dot(axis, axis), 1e-300);
    return a + std::clamp(t, 0.0, 1.0) * axis;
}

glm::dvec3 on_ball(const glm::dvec3& center, double radius, const glm::dvec3& x)
{
    const double distance = glm::distance(x, center);
    return distance > 0 ? center + radius / distance * (x - center) : center + glm::dvec3(0, radius, 0);
}

glm::dvec3 on_box(const glm::dvec3& half_size, const glm::dvec3& offset)
{
    const glm::dvec3 outside = glm::abs(offset) - half_size;
    glm::dvec3 point = glm::clamp(offset, -half_size, half_size);
    if (glm::all(glm::lessThan(outside, glm::dvec3(0))))
    {
        const int axis = outside.x >= outside.y && outside.x >= outside.z ? 0 : outside.y >= outside.z ? 1 : 2;
        point[axis] = offset[axis] < 0 ? -half_size[axis] : half_size[axis];
    }
    return point;
}

FindSurface surface_finder(const ColliderModel& collider, double distance)
{
    const shared::ColliderRecord& record = collider.record;
    const glm::dvec3 shape(record.shape);
    const auto size = static_cast<double>(record.shape.w);
    switch (record.kind)
    {
    case VOILE_COLLIDER_PLANE:
        return [=](const glm::dvec3& x) { return x - (glm::dot(shape, x) - size) * shape; };
    case VOILE_COLLIDER_SPHERE:
        return [=](const glm::dvec3& x) { return on_ball(glm::dvec3(0), size, x); };
    case VOILE_COLLIDER_CAPSULE:
        return [=](const glm::dvec3& x) { return on_ball(nearest_on_segment(-shape, shape, x), size, x); };
    case VOILE_COLLIDER_BOX:
        return [=](const glm::dvec3& x) { return on_box(shape, x); };
    default:
        return [bvh = collider.hierarchy, distance](const glm::dvec3& x) -> std::optional<glm::dvec3>
        {
            const auto nearest = nearest_point(*bvh, x, distance);
            return nearest ? std::optional(nearest->point) : std::nullopt;
        };
    }
}

} // namespace

Result<void> Solver::move_collider(ColliderId collider, const glm::mat4& motion)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    if (!is_rigid(motion))
        return Error{"collider " + std::to_string(collider.index) +
                     (finite(motion) ? ": its motion is not rigid" : ": its motion is not finite")};
    ColliderModel& model = *s.collider_models.colliders.find(collider);
    const glm::dvec4 center = glm::dmat4(model.placement) * glm::dvec4(model.origin, 1);
    const glm::vec3 moved(glm::dvec3(glm::dmat4(motion) * center));
    if (auto range = check("collider " + std::to_string(collider.index), "its center", moved, k_most_coordinate, " m");
        !range)
        return range;
    model.pose.to = motion;
    if (model.pose.anchor)
        s.model.anchors.find(*model.pose.anchor)->to = motion;
    uint32_t& flags = model.record.flags;
    if ((flags & VOILE_COLLIDER_MOVED) == 0 && motion != glm::mat4(1))
    {
        flags |= VOILE_COLLIDER_MOVED;
        s.edits.colliders.insert(collider.index);
        s.update_passes();
    }
    return {};
}

Result<void> Solver::teleport(ColliderId collider, const glm::mat4& motion)
{
    if (auto moved = move_collider(collider, motion); !moved)
        return moved;
    State& s = *state_;
    ColliderModel& model = *s.collider_models.colliders.find(collider);
    jump(model.pose);
    if (model.pose.anchor)
        jump(*s.model.anchors.find(*model.pose.anchor));
    s.wake_near(model.record.layers);
    return {};
}

Result<void> Solver::set_friction(ColliderId collider, const std::optional<Friction>& friction)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    if (friction)
        if (auto valid = check_friction("collider " + std::to_string(collider.index), friction->static_coefficient,
                                        friction->kinetic_coefficient);
            !valid)
            return valid;
    set_record_friction(s.collider_models.colliders.find(collider)->record, friction);
    s.update_collider(collider, false);
    return {};
}

Result<void> Solver::set_radius(ColliderId collider, float radius)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    const std::string what = "collider " + std::to_string(collider.index);
    ColliderModel& model = *s.collider_models.colliders.find(collider);
    if (model.record.kind != VOILE_COLLIDER_SPHERE && model.record.kind != VOILE_COLLIDER_CAPSULE)
        return Error{what + " has no radius: it is neither a sphere nor a capsule"};
    if (auto valid = check(what, {"radius", radius, k_least_collider_size, k_most_collider_size, " m"}); !valid)
        return valid;
    model.record.shape.w = radius;
    if (model.features)
    {
        const ColliderFeatures found = make_features(model, feature_scale(s.model, model.record.layers));
        model.features_due = model.features->set.features > 0 || found.set.features > 0;
    }
    s.update_collider(collider, false);
    return {};
}

Result<void> Solver::set_layers(ColliderId collider, uint32_t layers)
{
    State& s = *state_;
    if (auto exists = s.check(collider); !exists)
        return exists;
    s.wake_near(s.find(collider)->record.layers); // of the former ones, too
    s.collider_models.colliders.find(collider)->record.layers = layers;
    s.update_collider(collider, true);
    return {};
}

Result<void> Solver::set_layers(ClothId cloth, uint32_t layers)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists;
    s.model.cloths.find(cloth)->record.layers = layers;
    s.edits.records.insert(cloth.index);
    s.edits.candidates = true;
    for (const auto [index, collider] : s.collider_models.colliders)
        s.dirty |= s.options.feature_contact && needs_features(collider, s.model);
    return {};
}

Result<std::vector<Attachment>> Solver::attachments_on_surface(ClothId cloth, ColliderId collider, float distance)
{
    State& s = *state_;
    if (auto exists = s.check(cloth); !exists)
        return exists.error();
    if (auto exists = s.check(collider); !exists)
        return exists.error();
    if (!(distance >= 0) || !std::isfinite(distance))
        return Error{"attachments on a surface: the distance is " + std::to_string(distance) +
                     " m, must be finite and >= 0"};
    ColliderModel& model = *s.collider_models.colliders.find(collider);
    if ((model.record.flags & VOILE_COLLIDER_DEFORMS) != 0)
        return Error{"attachments on a surface: collider " + std::to_string(collider.index) +
                     " deforms, and attachments follow rigid motion only"};
    const auto limit = static_cast<double>(distance);
    const FindSurface find = surface_finder(model, limit);
    const glm::dmat4 placement(model.placement);
    const glm::dmat4 back = glm::inverse(placement);
    const glm::dvec3 origin = model.origin;
    const std::vector<glm::vec4>& start = s.find(cloth)->start;
    std::vector<Attachment> attachments;
    for (uint32_t i = 0; i < start.size(); ++i)
    {
        const glm::dvec3 world(start[i]);
        const glm::dvec3 x = glm::dvec3(back * glm::dvec4(world, 1)) - origin;
        if (const auto point = find(x); point && glm::distance(x, *point) <= limit)
            attachments.push_back(pin(i).at(glm::vec3(placement * glm::dvec4(*point + origin, 1))));
    }
    if (attachments.empty())
        return invalid("cloth", name(cloth), "no vertex starts within " + text(distance) + " m of the collider");
    ColliderPose& pose = model.pose;
    if (!pose.anchor)
    {
        auto anchor = add_anchor(pose.from);
        if (!anchor)
            return anchor.error();
        pose.anchor = anchor.value();
        s.model.anchors.find(*pose.anchor)->to = pose.to;
    }
    for (Attachment& attachment : attachments)
        attachment.anchor = pose.anchor;
    return attachments;
}

} // namespace voile
