// The meshes of the reference scene and the drape scene: two hearts and a ground. Generated here instead of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace scenes
{

// Both hearts are closed, wound outward and symmetric in shape, though not in mesh. They have 11,264 triangles of even
// size, positions and triangles only: loading the OBJ computes normals.

// An upright heart with a rounded tip and cleft. It fills the box x 3.385 to 6.615, y 1.507 to 4.534, z 5.958 to 8.042
// (meters). Width x depth at height: 0.78 x 0.82 at 1.6, 2.68 x 1.90 at 2.6, 3.23 x 2.08 at 3.3, 2.70 x 1.29 at 4.4,
// each within 3 %.
voile::engine::Mesh make_reference_heart();

// (x^2 + 9/4 z^2 + y^2 - 1)^3 = x^2 y^3 + 9/80 z^2 y^3 (Taubin 1994, "Distance approximations for rasterizing implicit
// curves"), times 0.6: y from -0.6 to 0.74.
voile::engine::Mesh make_drape_heart();

// The plane y = 0 as 50 x 50 vertices, 4,802 triangles facing up; 100 m square around x = z = 5.08, the middle of the
// reference scene's cloth.
voile::engine::Mesh make_ground();

} // namespace scenes
