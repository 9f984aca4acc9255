// The side of a plane that a point lies on, exactly.
#pragma once

#include <glm/glm.hpp>

namespace voile
{

// The sign of dot(cross(a - d, b - d), c - d) without rounding: -1, 0 or 1. 0 if and only if the points lie in one
// plane. Coordinates must be finite (Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates").
int orientation(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);

} // namespace voile
