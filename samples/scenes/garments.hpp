// The clothes of the walking figure and the curtains. Generated here instead of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace scenes
{

// Around the waist down to the knees, outside of the figure at phase 0. Texture coordinates in meters, u along the hem.
// `coarseness` divides the numbers of columns and rows, 1 to 4.
voile::engine::Mesh make_skirt(uint32_t coarseness = 1);
// On the shoulders and down the back of `figure`, which is the figure at phase 0, over its skirt. Otherwise like
// make_skirt.
voile::engine::Mesh make_cape(const voile::engine::Mesh& figure, uint32_t coarseness = 1);

// A curtain in even pleats: it follows a sine along x, from -0.54 to 0.54 m, and hangs from y = 0 to y = -1.84 m. Flat
// it is more than 1.6 times as wide. Texture coordinates in meters, u along the hem.
voile::engine::Mesh make_curtain();

} // namespace scenes
