// How colliders move: poses of the host's as the GPU reads them.
#pragma once

#include "colliders/collider_model.hpp"
#include "voile/solver.hpp"

namespace voile
{

// From where a collider was added to where it is.
struct ColliderPose
{
    glm::mat4 from{1.f};              // at the end of the last step
    glm::mat4 to{1.f};                // at the end of the next one
    std::optional<AnchorId> anchor{}; // of the holds on its surface
};

// Where the vertices of a deforming mesh are.
struct Deformation
{
    uint32_t now = 0;                     // the half of its positions that holds them at the end of the last step
    bool due = false;                     // new vertices were given: the next step goes to them, in the other half
    std::vector<glm::vec3> positions;     // given by the host, m
    std::optional<DeviceVertices> source; // or where they lie on the GPU
};

// Whether the collider is, or may come to be, elsewhere than where it was added.
inline bool is_moving(const shared::ColliderRecord& collider)
{
    return (collider.flags & (VOILE_COLLIDER_MOVED | VOILE_COLLIDER_DEFORMS)) != 0;
}

// Whether a transform turns and moves without scale or reflection: finite, columns of unit length and at right angles
// within 1e-4.
bool is_rigid(const glm::mat4& transform);

// `deformations`: of models.deforming.
shared::ColliderMotion make_motion(const ColliderModels& models, uint32_t collider, const ColliderPose& pose,
                                   std::span<const Deformation> deformations);

} // namespace voile
