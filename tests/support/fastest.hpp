// The fastest of some vertices.
#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace tests
{

// m/s; infinite if a velocity is not finite.
inline float fastest(const std::vector<glm::vec4>& velocities)
{
    float speed = 0;
    for (const glm::vec4& v : velocities)
        speed = std::max(speed, std::isfinite(v.x) ? glm::length(glm::vec3(v)) : INFINITY);
    return speed;
}

} // namespace tests
