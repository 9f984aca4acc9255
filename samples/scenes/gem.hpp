// The mesh of the moving scene, a ball with flat faces, and of the jelly scene, the same gone soft; made here instead
// of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace scenes
{

// 80 flat triangles around the origin, closed and wound outwards: an icosahedron whose faces are cut in four, its
// twelve corners 0.4 m from the origin and those between 0.36 m, so that it has ridges that take cloth along. Every
// face has vertices of its own, so that computed normals leave it flat.
voile::engine::Mesh make_gem();

// The gem gone soft: 0.4 m above the origin at 0 s, where it is the gem as it was. It is squashed and rises again every
// 1.6 s, its volume kept, and its top sways from side to side every 2.5 s; what is at y = 0 stays.
voile::engine::Mesh make_jelly(double seconds);

constexpr uint32_t k_jelly_frames = 61; // of the sequence
constexpr uint32_t k_jelly_rate = 12;   // a second

} // namespace scenes
