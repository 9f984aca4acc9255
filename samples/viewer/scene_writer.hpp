// Writes a scene as JSON.
#pragma once

#include "samples/viewer/scene_file.hpp"

namespace viewer
{

// The text of a scene file in `folder`: what parse_scene makes of it equals `scene` but for the locations of its
// entries. Keys that have their default are left out. Paths are relative to the folder, which need not exist.
std::string scene_text(const SceneFile& scene, const std::filesystem::path& folder);

// Writes it to a file whose folder exists. Errors name the file and the reason.
voile::Result<void> save_scene(const SceneFile& scene, const std::filesystem::path& path);

} // namespace viewer
