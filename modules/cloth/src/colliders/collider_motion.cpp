// How colliders move: poses of the host's as the GPU reads them.
#include "colliders/collider_motion.hpp"

#include "geometry/rounding.hpp"

#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace voile
{

namespace
{

glm::dquat rotation_of(const glm::dmat4& rigid)
{
    return glm::normalize(glm::quat_cast(glm::dmat3(rigid)));
}

glm::vec4 components(const glm::dquat& q)
{
    return glm::dvec4(q.x, q.y, q.z, q.w);
}

} // namespace

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

shared::ColliderMotion make_motion(const ColliderModels& models, uint32_t collider, const ColliderPose& pose,
                                   std::span<const Deformation> deformations)
{
    // In double: floats of what is far from the origin are coarse.
    const glm::dmat4 placement(models.colliders[collider].placement);
    const glm::dmat4 from = glm::dmat4(pose.from) * placement;
    const glm::dmat4 to = glm::dmat4(pose.to) * placement;
    const glm::dquat rotation_from = rotation_of(from);
    glm::dquat rotation_to = rotation_of(to);
    if (glm::dot(rotation_from, rotation_to) < 0)
        rotation_to = -rotation_to; // the shorter way
    shared::ColliderMotion motion{};
    motion.rotation_from = components(rotation_from);
    motion.rotation_to = components(rotation_to);
    const glm::dvec4 origin(models.colliders[collider].origin, 1);
    const glm::dvec3 place_from(from * origin);
    motion.origin = rounded(place_from);
    motion.place_from = place_from - glm::dvec3(motion.origin);
    motion.place_to = glm::dvec3(to * origin) - glm::dvec3(motion.origin);
    for (size_t i = 0; i < models.deforming.size(); ++i)
        if (models.deforming[i].collider == collider)
        {
            const Deformation& deformation = deformations[i];
            motion.first_from = models.deforming[i].first(deformation.now);
            motion.first_to = models.deforming[i].first(deformation.due ? 1 - deformation.now : deformation.now);
        }
    return motion;
}

} // namespace voile
