// Stability bounds, and the substeps that follow from them.
#include "model/stability.hpp"

#include "voile/ranges.hpp"

#include "model/cloth_model.hpp"

#include "shared/strain_layout.h"

#include <algorithm>
#include <cmath>

namespace voile
{

namespace
{

bool uses_verlet(const shared::ClothRecord& record)
{
    return (record.flags & VOILE_CLOTH_VERLET) != 0;
}

} // namespace

shared::StabilityScales stability_scales(const shared::ClothRecord& record, double substep)
{
    const auto omega_squared = static_cast<double>(record.omega_squared);
    const auto decay = static_cast<double>(record.decay);
    const bool verlet = uses_verlet(record);
    shared::StabilityScales scales = shared::stability_scales(verlet, omega_squared, decay, substep);
    if (!verlet)
        scales.load =
            std::max(std::sqrt(scales.stiffness * omega_squared), scales.damping * decay) * substep / VOILE_RK4_RADIUS;
    return scales;
}

uint32_t stable_substeps(const shared::ClothRecord& record, double duration)
{
    const double omega = std::sqrt(static_cast<double>(record.omega_squared));
    const auto decay = static_cast<double>(record.decay);
    double longest = 0; // the longest substep, s, times `fastest`
    double fastest = 0; // 1/s
    if (uses_verlet(record))
    {
        // (omega h / 2)^2 + decay h / 2 = margin^2, solved for 1 / h.
        const double half = 0.25 * decay;
        longest = VOILE_STABILITY_MARGIN * VOILE_STABILITY_MARGIN;
        fastest = half + std::sqrt(half * half + 0.25 * omega * omega * longest);
    }
    else
    {
        longest = VOILE_STABILITY_MARGIN * VOILE_RK4_RADIUS;
        fastest = std::max(omega, decay);
    }
    const double substeps = std::ceil(duration * fastest / longest * (1 - 1e-6)); // a whole number stays one in float
    return static_cast<uint32_t>(std::clamp(substeps, 1.0, static_cast<double>(k_most_substeps)));
}

Softening softening_of(const ClothModel& cloth, const Step& step, const SubstepPlan& plan)
{
    constexpr double k_recovery = 0.5; // s
    constexpr double k_least = 1e-3;   // of a substep; less is rounding
    const auto duration = static_cast<double>(step.duration);
    const uint32_t needed = stable_substeps(cloth.record, duration);
    const uint32_t used = plan.substeps_of(plan.level_of(needed));
    const double substep = duration / used;
    const auto before = static_cast<double>(cloth.softened_substep);
    if (before > substep)
    {
        const double held = substep + (before - substep) * std::exp(-duration / k_recovery);
        if (held > (1 + k_least) * substep)
            return {true, static_cast<float>(held), static_cast<float>(held)};
    }
    return used < needed ? Softening{true, static_cast<float>(substep), 0} : Softening{};
}

StrainLimit strain_limit(const ClothModel& cloth, const Step& step, const Softening& softening)
{
    const float own = std::visit([](const auto& m) { return m.strain_limit; }, cloth.material);
    if (own > 0 || step.softened_strain_limit == 0 || step.substeps > 0 || !softening.is_soft)
        return {own, VOILE_STRAIN_PASSES};
    return {step.softened_strain_limit, VOILE_SOFTENED_STRAIN_PASSES};
}

double largest_eigenvalue(double xx, double xy, double yy)
{
    return 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
}

} // namespace voile
