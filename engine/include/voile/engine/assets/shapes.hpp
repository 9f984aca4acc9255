// Simple procedural meshes.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace voile::engine
{

// `rings` bands from pole to pole, twice as many segments around.
Mesh make_sphere(const glm::vec3& center, float radius, uint32_t rings = 48);

// All points within `radius` of the segment between both points, which may be equal. `rings` bands on both ends
// together.
Mesh make_capsule(const glm::vec3& from, const glm::vec3& to, float radius, uint32_t rings = 48);

// The half of the unit sphere around the origin with y >= 0, open below. `rings` bands from pole to rim, four times as
// many segments around.
Mesh make_dome(uint32_t rings = 24);

// The side of a cylinder of radius 1 around the y axis, from y = 0 to 1, open at both ends.
Mesh make_tube(uint32_t segments = 96);

// A rotation that maps the y axis to `axis`, which has unit length.
glm::mat3 turn_to(const glm::vec3& axis);

// A box with flat faces.
Mesh make_box(const glm::vec3& min, const glm::vec3& max);

// A square in the plane y = `y`, centered below the origin, `half_size` m to each side, facing up.
Mesh make_ground(float half_size, float y = 0);

} // namespace voile::engine
