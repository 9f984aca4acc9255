// Stability bounds, and the substeps that follow from them.
#include "stability.hpp"

#include "cloth/ranges.hpp"

#include <algorithm>
#include <cmath>

namespace cloth
{

namespace
{

// As in stability.glsl.
constexpr double k_rk4_reach = 2.6;
constexpr double k_margin = 0.95;

bool uses_verlet(const shared::ClothRecord& record)
{
    return (record.flags & VOILE_CLOTH_VERLET) != 0;
}

double verlet_share(double load)
{
    const double borne = std::min(1.0, 1 / std::max(load, 1e-30));
    return borne * std::max(borne, 0.5);
}

} // namespace

StableShares stable_shares(const shared::ClothRecord& record, double substep)
{
    const auto omega_squared = static_cast<double>(record.omega_squared);
    const auto decay = static_cast<double>(record.decay);
    if (uses_verlet(record))
    {
        constexpr double k_reach = k_margin * k_margin;
        const double elastic = 0.25 * omega_squared * substep * substep;
        const double damping = decay * substep;
        const double stiffness = verlet_share((elastic + damping) / k_reach);
        const double left = k_reach - stiffness * elastic;
        return {stiffness, stiffness < 1 ? std::min(1.0, left / std::max(damping, 1e-30)) : 1};
    }
    const double reach = k_margin * k_rk4_reach / substep;
    return {std::min(1.0, reach * reach / std::max(omega_squared, 1e-30)),
            std::min(1.0, reach / std::max(decay, 1e-30))};
}

uint32_t stable_substeps(const shared::ClothRecord& record, double duration)
{
    const double omega = std::sqrt(static_cast<double>(record.omega_squared));
    const auto decay = static_cast<double>(record.decay);
    double longest = 0; // substep, s, times (omega or decay)
    double fastest = 0; // 1/s
    if (uses_verlet(record))
    {
        // (omega h / 2)^2 + decay h = margin^2, solved for 1 / h.
        const double half = 0.5 * decay;
        longest = k_margin * k_margin;
        fastest = half + std::sqrt(half * half + 0.25 * omega * omega * longest);
    }
    else
    {
        longest = k_margin * k_rk4_reach;
        fastest = std::max(omega, decay);
    }
    const double substeps = std::ceil(duration * fastest / longest * (1 - 1e-6)); // a whole number stays one in float
    return static_cast<uint32_t>(std::clamp(substeps, 1.0, static_cast<double>(k_most_substeps)));
}

double largest_eigenvalue(const glm::dmat3& m)
{
    const double mean = (m[0][0] + m[1][1] + m[2][2]) / 3;
    const glm::dmat3 deviation = m - mean * glm::dmat3(1.0);
    double squares = 0;
    for (int column = 0; column < 3; ++column)
        squares += glm::dot(deviation[column], deviation[column]);
    const double p = std::sqrt(squares / 6);
    if (p <= 1e-12 * mean)
        return mean;
    const double half_determinant = std::clamp(0.5 * glm::determinant(deviation) / (p * p * p), -1.0, 1.0);
    return mean + 2 * p * std::cos(std::acos(half_determinant) / 3);
}

} // namespace cloth
