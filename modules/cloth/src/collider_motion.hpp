// How colliders move: poses of the host's as the GPU reads them.
#pragma once

#include "cloth/holds.hpp"
#include "model.hpp"

namespace cloth
{

// From where a collider was added to where it is.
struct ColliderPose
{
    glm::mat4 from{1.f};              // at the end of the last step
    glm::mat4 to{1.f};                // at the end of the next one
    std::optional<AnchorId> anchor{}; // of the holds on its surface
};

// Whether a transform turns and moves without scale or reflection: finite, columns of unit length and at right angles
// within 1e-4.
bool is_rigid(const glm::mat4& transform);

shared::ColliderMotion make_motion(const Model& model, uint32_t collider, const ColliderPose& pose);

} // namespace cloth
