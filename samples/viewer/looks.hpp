// How a cloth of a scene is drawn: by its material, by its number, and by the key "look".
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "voile/engine/scene/component.hpp"

namespace viewer
{

// `index`: of the cloth in the scene; cloths without a color of their own take four colors in turn. `size`: m, the
// longer side of the cloth.
voile::engine::Surface cloth_surface(const ClothEntry& cloth, size_t index, float size);

voile::engine::Surface solid_surface(const SolidLookEntry& look);

} // namespace viewer
