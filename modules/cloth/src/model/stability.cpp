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

namespace
{

struct SubstepsOfCloth
{
    uint32_t needed;
    uint32_t used;
    [[nodiscard]] bool are_too_few() const { return used < needed; }
};

SubstepsOfCloth substeps_of(const ClothModel& cloth, const Step& step, const SubstepPlan& plan)
{
    const uint32_t needed = stable_substeps(cloth.record, static_cast<double>(step.duration));
    return {needed, plan.substeps_of(plan.level_of(needed))};
}

} // namespace

float held_substep(const ClothModel& cloth, const Step& step, const SubstepPlan& plan)
{
    constexpr double k_recovery = 0.5; // s
    constexpr double k_least = 1e-3;   // of a substep; less is rounding
    const SubstepsOfCloth substeps = substeps_of(cloth, step, plan);
    const double substep = static_cast<double>(step.duration) / substeps.used;
    const auto before = static_cast<double>(cloth.softened_substep);
    const double held = substep + (before - substep) * std::exp(-static_cast<double>(step.duration) / k_recovery);
    if (held > (1 + k_least) * substep)
        return static_cast<float>(held);
    return substeps.are_too_few() ? static_cast<float>(substep) : 0;
}

float softened_substep(const ClothModel& cloth, const Step& step, const SubstepPlan& plan)
{
    const float held = held_substep(cloth, step, plan);
    const auto used = static_cast<float>(substeps_of(cloth, step, plan).used);
    return held * used > step.duration * (1 + 1e-4f) ? held : 0;
}

StrainLimit strain_limit(const ClothModel& cloth, const Step& step, const SubstepPlan& plan)
{
    const float own = std::visit([](const auto& m) { return m.strain_limit; }, cloth.material);
    const StrainLimit of_material{own, VOILE_STRAIN_PASSES};
    if (own > 0 || step.softened_strain_limit == 0 || step.substeps > 0 || cloth.mesh)
        return of_material;
    const bool softened = substeps_of(cloth, step, plan).are_too_few() || softened_substep(cloth, step, plan) > 0;
    return softened ? StrainLimit{step.softened_strain_limit, VOILE_SOFTENED_STRAIN_PASSES} : of_material;
}

double largest_eigenvalue(double xx, double xy, double yy)
{
    return 0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy);
}

} // namespace voile
