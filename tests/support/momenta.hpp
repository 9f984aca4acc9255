// Momenta of a cloth without pins.
#pragma once

#include "support/cloth_harness.hpp"

namespace tests
{

struct Momenta
{
    glm::dvec3 moment{0};  // kg m, of the masses about the origin
    glm::dvec3 linear{0};  // kg m/s
    glm::dvec3 angular{0}; // kg m^2/s, about the center of mass
    double speeds = 0;     // kg m/s, the sum of all magnitudes
};

inline Momenta momenta_of(ClothHarness& harness, voile::ClothId id)
{
    const auto x = harness.positions(id);
    const auto v = harness.velocities(id);
    Momenta result;
    double mass = 0;
    for (const glm::vec4& p : x)
    {
        result.moment += glm::dvec3(p) / static_cast<double>(p.w);
        mass += 1 / static_cast<double>(p.w);
    }
    const glm::dvec3 center = result.moment / mass;
    for (size_t i = 0; i < x.size(); ++i)
    {
        const glm::dvec3 momentum = glm::dvec3(v[i]) / static_cast<double>(x[i].w);
        result.linear += momentum;
        result.angular += glm::cross(glm::dvec3(x[i]) - center, momentum);
        result.speeds += glm::length(momentum);
    }
    return result;
}

// Sets the velocities of a rotation about the mean of the positions. `turn`: rad/s.
inline void spin(ClothHarness& harness, voile::ClothId id, const glm::dvec3& turn)
{
    const auto x = harness.positions(id);
    glm::dvec3 center(0);
    for (const glm::vec4& p : x)
        center += glm::dvec3(p) / static_cast<double>(x.size());
    std::vector<glm::vec4> turning;
    turning.reserve(x.size());
    for (const glm::vec4& p : x)
        turning.emplace_back(glm::vec3(glm::cross(turn, glm::dvec3(p) - center)), 0.f);
    harness.set_velocities(id, turning);
}

} // namespace tests
