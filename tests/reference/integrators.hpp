// Textbook integrators for any reference cloth with accelerations(state, environment).
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace reference
{

struct ClothState
{
    std::vector<glm::dvec3> x;
    std::vector<glm::dvec3> v;
};

struct Environment
{
    glm::dvec3 gravity{0, -9.81, 0};
    glm::dvec3 wind{0.0};
    double air_density = 1.225;
};

inline std::vector<glm::dvec3> sum(const std::vector<glm::dvec3>& a, double h, const std::vector<glm::dvec3>& b)
{
    std::vector<glm::dvec3> result = a;
    for (size_t i = 0; i < a.size(); ++i)
        result[i] += h * b[i];
    return result;
}

// Kutta 1901. Held vertices have neither velocity nor acceleration, so they stay.
template <typename Cloth>
void rk4_step(const Cloth& cloth, ClothState& s, double h, const Environment& environment)
{
    const auto a1 = cloth.accelerations(s, environment);
    const ClothState s2{sum(s.x, h / 2, s.v), sum(s.v, h / 2, a1)};
    const auto a2 = cloth.accelerations(s2, environment);
    const ClothState s3{sum(s.x, h / 2, s2.v), sum(s.v, h / 2, a2)};
    const auto a3 = cloth.accelerations(s3, environment);
    const ClothState s4{sum(s.x, h, s3.v), sum(s.v, h, a3)};
    const auto a4 = cloth.accelerations(s4, environment);
    for (size_t i = 0; i < s.x.size(); ++i)
    {
        s.x[i] += h / 6 * (s.v[i] + 2.0 * s2.v[i] + 2.0 * s3.v[i] + s4.v[i]);
        s.v[i] += h / 6 * (a1[i] + 2.0 * a2[i] + 2.0 * a3[i] + a4[i]);
    }
}

// Swope et al. 1982: x += h v + h^2/2 a, v += h/2 (a + a'). If a' depends on the velocity, it takes v + (1/2 + p) h a:
// the half kick, and p of another by the acceleration before, p = (1 - load) / 2. The last a' of a substep is the first
// a of the next, so a step of n substeps evaluates n + 1 of them.
template <typename Cloth>
void verlet_step(const Cloth& cloth, ClothState& s, double h, uint32_t substeps, const Environment& environment,
                 double load)
{
    auto a = cloth.accelerations(s, environment);
    for (uint32_t substep = 0; substep < substeps; ++substep)
    {
        const auto halfway = sum(s.v, h / 2, a);
        s.x = sum(s.x, h, halfway);
        a = cloth.accelerations({s.x, sum(halfway, (1 - load) / 2 * h, a)}, environment);
        s.v = sum(halfway, h / 2, a);
    }
}

} // namespace reference
