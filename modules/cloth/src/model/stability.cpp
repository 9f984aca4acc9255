// Stability bounds, and the substeps that follow from them.
#include "model/stability.hpp"

#include "voile/ranges.hpp"

#include <algorithm>
#include <cmath>

namespace voile
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

} // namespace

StabilityScales stability_scales(const shared::ClothRecord& record, double substep)
{
    const auto omega_squared = static_cast<double>(record.omega_squared);
    const auto decay = static_cast<double>(record.decay);
    if (uses_verlet(record))
    {
        const double load = 0.25 * omega_squared * substep * substep + 0.5 * decay * substep;
        const double scale = std::min(1.0, k_margin * k_margin / std::max(load, 1e-30));
        return {scale, scale, scale * load};
    }
    const double reach = k_margin * k_rk4_reach / substep;
    const double stiffness = std::min(1.0, reach * reach / std::max(omega_squared, 1e-30));
    const double damping = std::min(1.0, reach / std::max(decay, 1e-30));
    const double load = std::max(std::sqrt(stiffness * omega_squared), damping * decay) * substep / k_rk4_reach;
    return {stiffness, damping, load};
}

uint32_t stable_substeps(const shared::ClothRecord& record, double duration)
{
    const double omega = std::sqrt(static_cast<double>(record.omega_squared));
    const auto decay = static_cast<double>(record.decay);
    double longest = 0; // substep, s, times (omega or decay)
    double fastest = 0; // 1/s
    if (uses_verlet(record))
    {
        // (omega h / 2)^2 + decay h / 2 = margin^2, solved for 1 / h.
        const double half = 0.25 * decay;
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

double largest_eigenvalue(double xx, double xy, double yy)
{
    return 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
}

} // namespace voile
