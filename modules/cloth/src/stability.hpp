// Stability: how fast a cloth's fastest modes are, and how many substeps they need.
#pragma once

#include "cloth/descriptions.hpp"

#include "cloth_layout.h"

#include <glm/glm.hpp>

namespace cloth
{

// What a step bears of a cloth's stiffness and damping; see shaders/cloth/stability.glsl, which has the same formulas.
struct StableShares
{
    double stiffness = 1;
    double damping = 1;
};
StableShares stable_shares(const shared::ClothRecord& record, double substep);

// The fewest substeps of a step of `duration` seconds that bear all of the stiffness and damping.
uint32_t stable_substeps(const shared::ClothRecord& record, double duration);

// Largest eigenvalue of a symmetric matrix (Smith 1961). It and the vertex's mass bound the spectrum of M^-1 K: the sum
// over springs of k (d . (u_i - u_j))^2 is at most the sum over vertices of 2 u_i^T (sum_j k d d^T) u_i.
double largest_eigenvalue(const glm::dmat3& symmetric);

} // namespace cloth
