// Materials of scene files as the cloth module takes them.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "voile/material.hpp"

#include <optional>

namespace viewer
{

// The material of a cloth. `spacing`: of a grid, m, along rows and along columns; none for a mesh. Values of a fabric
// hold at every resolution. Raw values (vertex_mass, spring_stiffness ...) of a grid replace those that follow from the
// fabric. Errors name the position in the file: an unknown preset, values that do not go together or are out of range.
voile::Result<voile::ClothMaterial> make_cloth_material(const SceneFile& scene, const MaterialEntry& entry,
                                                        const std::optional<glm::vec2>& spacing);

// The entry of which make_cloth_material makes this material.
MaterialEntry entry_of(const voile::ClothMaterial& material);

} // namespace viewer
