// Stability: how fast a cloth's fastest modes are, and how many substeps they need.
#pragma once

#include "voile/descriptions.hpp"

#include "shared/cloth_layout.h"
#include "shared/stability.h"

namespace voile
{

// The factors that the kernels apply to a cloth's stiffness and damping in a substep (s). `load` under RK4, too: the
// fraction of the stability region along an axis.
shared::StabilityScales stability_scales(const shared::ClothRecord& record, double substep);

// The smallest number of substeps of a step of `duration` seconds that keeps all stiffness and damping. At least 1.
uint32_t stable_substeps(const shared::ClothRecord& record, double duration);

// Of the symmetric matrix (xx, xy; xy, yy).
double largest_eigenvalue(double xx, double xy, double yy);

} // namespace voile
