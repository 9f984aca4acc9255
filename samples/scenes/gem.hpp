// The meshes of the moving scene, a ball with flat faces, and of the jelly scene, the same ball made soft. Generated
// here instead of shipped.
#pragma once

#include "voile/engine/assets/mesh.hpp"

namespace scenes
{

// 80 flat triangles around the origin, closed and wound outward: an icosahedron whose faces are split in four, its
// twelve corners 0.4 m from the origin and the other vertices 0.36 m, so that its ridges drag cloth along. Every face
// has its own vertices, so that computed normals are flat.
voile::engine::Mesh make_gem();

// The soft gem. At 0 s it is the gem, 0.4 m above the origin. It is squashed and rises again every 1.6 s with constant
// volume, and its top sways from side to side every 2.5 s. Points at y = 0 stay.
voile::engine::Mesh make_jelly(double seconds);

constexpr uint32_t k_jelly_frames = 61; // of the sequence
constexpr uint32_t k_jelly_rate = 12;   // per second

} // namespace scenes
