// Stability: how fast a cloth's fastest modes are, and how many substeps they need.
#pragma once

#include "voile/descriptions.hpp"
#include "voile/step.hpp"

#include "model/substep_plan.hpp"

#include "shared/cloth_layout.h"
#include "shared/stability.h"

namespace voile
{

struct ClothModel;

// The factors that the kernels apply to a cloth's stiffness and damping in a substep (s). `load` under RK4, too: the
// fraction of the stability region along an axis.
shared::StabilityScales stability_scales(const shared::ClothRecord& record, double substep);

// The smallest number of substeps of a step of `duration` seconds that keeps all stiffness and damping. At least 1.
uint32_t stable_substeps(const shared::ClothRecord& record, double duration);

// How a step softens a cloth. Where steps differ in their length, a budget of substeps would soften cloth differently
// in each of them, and each change of stiffness would change the energy of its springs: alternating steps would shake
// it. So a long step softens at once, and stiffness comes back slowly.
struct Softening
{
    bool is_soft = false;       // it takes fewer substeps than it needs, or has done so
    float substep = 0;          // s, that it is softened for; the next step holds it
    float softened_substep = 0; // s, for the record: the same where it is longer than those of the step, else 0
};
Softening softening_of(const ClothModel& cloth, const Step& step, const SubstepPlan& plan);

// The strain limit of a cloth in a step.
struct StrainLimit
{
    float most = 0;      // l / L - 1; 0: none
    uint32_t passes = 0; // on each level
    bool operator==(const StrainLimit&) const = default;
};
inline StrainLimit strain_limit(const shared::ClothRecord& record)
{
    return {record.strain_limit, record.strain_passes};
}
// Its material's. If that has none and the step softens the cloth, the step's.
StrainLimit strain_limit(const ClothModel& cloth, const Step& step, const Softening& softening);

// Of the symmetric matrix (xx, xy; xy, yy).
double largest_eigenvalue(double xx, double xy, double yy);

} // namespace voile
