// Materials of scene files as the cloth module takes them.
#pragma once

#include "samples/viewer/scene_file.hpp"

#include "cloth/material.hpp"

namespace viewer
{

// The material of a grid with the given spacing (m, along rows and along columns). A fabric's values give springs that
// behave alike at every resolution; raw values (vertex_mass, spring_stiffness ...) then replace what they name. Errors
// name the place in the file: an unknown preset, values that do not go together or are out of range, a feature that the
// module does not have.
gpu::Result<cloth::Material> make_grid_material(const SceneFile& scene, const MaterialEntry& entry,
                                                const glm::vec2& spacing);

} // namespace viewer
