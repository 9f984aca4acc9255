// The clothes of the walking figure and the curtains. Generated here instead of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace scenes
{

// Around the waist down to the knees, and over the shoulders and the back, outside of the figure at phase 0. Texture
// coordinates in meters, u along the hem. `coarseness` divides the numbers of columns and rows, 1 to 4.
voile::engine::Mesh make_skirt(uint32_t coarseness = 1);
voile::engine::Mesh make_cape(uint32_t coarseness = 1);

// A curtain in even pleats: it follows a sine along x, from -0.54 to 0.54 m, and hangs from y = 0 to y = -1.84 m. Flat
// it is more than 1.6 times as wide. Texture coordinates in meters, u along the hem.
voile::engine::Mesh make_curtain();

} // namespace scenes
