// Stability: how fast a cloth's fastest modes are, and how many substeps they need.
#pragma once

#include "voile/descriptions.hpp"

#include "shared/cloth_layout.h"

namespace voile
{

// What a step bears of a cloth's stiffness and damping; see shaders/cloth/stability.glsl, which has the same formulas.
struct StabilityScales
{
    double stiffness = 1;
    double damping = 1;
    double load = 0; // what is left of both takes up so much of what the step bears, 0..1
};
StabilityScales stability_scales(const shared::ClothRecord& record, double substep);

// The fewest substeps of a step of `duration` seconds that bear all of the stiffness and damping.
uint32_t stable_substeps(const shared::ClothRecord& record, double duration);

// Of the symmetric matrix (xx, xy; xy, yy).
double largest_eigenvalue(double xx, double xy, double yy);

} // namespace voile
