// The mesh of the moving scene: a ball with flat faces, made here instead of shipped.
#pragma once

#include "engine/assets/mesh.hpp"

namespace scenes
{

// 80 flat triangles around the origin, closed and wound outwards: an icosahedron whose faces are cut in four, its
// twelve corners 0.4 m from the origin and those between 0.36 m, so that it has ridges that take cloth along. Every
// face has vertices of its own, so that computed normals leave it flat.
engine::Mesh make_gem();

} // namespace scenes
