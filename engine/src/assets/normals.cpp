// Normals weighted by angle.
#include "voile/engine/assets/normals.hpp"

#include <array>
#include <cmath>

namespace voile::engine
{

void sum_normals(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                 std::vector<glm::dvec3>& sums)
{
    sums.assign(positions.size(), glm::dvec3(0.));
    for (const glm::uvec3& t : triangles)
    {
        const std::array<glm::dvec3, 3> p{positions[t.x], positions[t.y], positions[t.z]};
        const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        if (across == glm::dvec3(0.))
            continue;
        const glm::dvec3 normal = glm::normalize(across);
        for (size_t i = 0; i < 3; ++i)
        {
            const glm::dvec3 a = p[(i + 1) % 3] - p[i];
            const glm::dvec3 b = p[(i + 2) % 3] - p[i];
            const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
            sums[t[static_cast<int>(i)]] += angle * normal;
        }
    }
}

glm::vec3 unit_normal(const glm::dvec3& sum)
{
    const double length = glm::length(sum);
    return length > 1e-9 ? glm::vec3(sum / length) : glm::vec3(0.f, 1.f, 0.f);
}

} // namespace voile::engine
