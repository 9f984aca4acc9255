// Materials of scene files as the cloth module takes them.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "voile/material.hpp"

#include <optional>

namespace viewer
{

// What a cloth is made of; `spacing` (m, along rows and along columns) is a grid's, a mesh has none. A fabric's values
// behave alike at every resolution; raw values (vertex_mass, spring_stiffness ...) of a grid replace what they name in
// the springs that follow from it. Errors name the place in the file: an unknown preset, values that do not go together
// or are out of range.
voile::Result<voile::ClothMaterial> make_cloth_material(const SceneFile& scene, const MaterialEntry& entry,
                                                        const std::optional<glm::vec2>& spacing);

} // namespace viewer
