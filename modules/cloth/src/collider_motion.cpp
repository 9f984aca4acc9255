// How colliders move: poses of the host's as the GPU reads them.
#include "collider_motion.hpp"

#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace cloth
{

namespace
{

glm::quat rotation_of(const glm::mat4& rigid)
{
    return glm::normalize(glm::quat_cast(glm::mat3(rigid)));
}

glm::vec4 components(const glm::quat& q)
{
    return {q.x, q.y, q.z, q.w};
}

} // namespace

glm::vec3 center_of(const shared::ColliderRecord& record)
{
    const glm::vec3 shape(record.shape);
    switch (record.kind)
    {
    case VOILE_COLLIDER_MESH:
        return 0.5f * (record.box_min + record.box_max);
    case VOILE_COLLIDER_PLANE:
        return record.shape.w * shape;
    case VOILE_COLLIDER_CAPSULE:
        return 0.5f * (shape + glm::vec3(record.second));
    default:
        return shape;
    }
}

bool is_rigid(const glm::mat4& transform)
{
    constexpr float k_tolerance = 1e-4f;
    if (!finite(transform))
        return false;
    const glm::mat3 turn(transform);
    const glm::mat3 product = glm::transpose(turn) * turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row ? 1.f : 0.f)) <= k_tolerance))
                return false;
    const bool affine =
        transform[0].w == 0 && transform[1].w == 0 && transform[2].w == 0 && transform[3].w == 1; // the last row
    return affine && glm::determinant(turn) > 0;
}

shared::ColliderMotion make_motion(const Model& model, uint32_t collider, const ColliderPose& pose,
                                   std::span<const Deformation> deformations)
{
    const glm::mat4 from = pose.from * model.placements[collider];
    const glm::mat4 to = pose.to * model.placements[collider];
    const glm::quat rotation_from = rotation_of(from);
    glm::quat rotation_to = rotation_of(to);
    if (glm::dot(rotation_from, rotation_to) < 0)
        rotation_to = -rotation_to; // the shorter way
    shared::ColliderMotion motion{};
    motion.rotation_from = components(rotation_from);
    motion.rotation_to = components(rotation_to);
    motion.center = center_of(model.colliders[collider]);
    motion.place_from = glm::vec3(from * glm::vec4(motion.center, 1));
    motion.place_to = glm::vec3(to * glm::vec4(motion.center, 1));
    for (size_t i = 0; i < model.deforming.size(); ++i)
        if (model.deforming[i].collider == collider)
        {
            const Deformation& deformation = deformations[i];
            motion.first_from = model.deforming[i].first(deformation.now);
            motion.first_to = model.deforming[i].first(deformation.due ? 1 - deformation.now : deformation.now);
        }
    return motion;
}

} // namespace cloth
