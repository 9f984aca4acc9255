// Letters for the stages of sample scenes.
#pragma once

#include "voile/engine/assets/mesh.hpp"

#include <string_view>

namespace scenes
{

// A text as raised squares, five by seven per letter, centered on the origin in the plane z = 0 and facing +z.
// `height`: of a letter, m. Letters: those of the names of the fabric presets, lower case, and those of
// numbers.
voile::engine::Mesh make_label(std::string_view text, float height);

} // namespace scenes
