// How colliders move: poses of the host's as the GPU reads them.
#pragma once

#include "colliders/collider_model.hpp"

namespace voile
{

// Whether the collider is, or may come to be, elsewhere than where it was added.
inline bool is_moving(const shared::ColliderRecord& collider)
{
    return (collider.flags & (VOILE_COLLIDER_MOVED | VOILE_COLLIDER_DEFORMS)) != 0;
}

// Whether a transform turns and moves without scale or reflection: finite, columns of unit length and at right angles
// within 1e-4.
bool is_rigid(const glm::mat4& transform);

// Its motion in the next step.
shared::ColliderMotion make_motion(const ColliderModel& collider);

} // namespace voile
