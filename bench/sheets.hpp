// The sheets of the cases.
#pragma once

#include "voile/solver.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace bench
{

constexpr float k_reference_spacing = 0.08f; // m

// The reference scene's cloth: flat at y = 4.8, its first corner at x, z.
voile::GridCloth reference_grid(uint32_t side, float x, float z);

// The drape scene's cloth (samples/scenes/drape.json): 2.4 m square, side x side vertices, no air.
voile::GridCloth drape_grid(uint32_t side);

// The same with velocity Verlet.
voile::GridCloth verlet_grid(uint32_t side, bool self_collision);

// A grid of the drape scene as a triangle mesh, with the diagonals of the solver's grids, its material, integrator
// and pins.
voile::ClothId add_as_mesh(voile::Solver& solver, const voile::GridCloth& grid, bool shuffled,
                           voile::BendingModel bending);

// The drape scene's sheet in 12 folds that stand upright on the ground (m, its height). They lean, more at one end
// than at the other, and fall over each other.
std::vector<glm::vec4> folds_upright_on(float ground, uint32_t side);

} // namespace bench
