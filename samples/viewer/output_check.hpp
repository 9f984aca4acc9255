// Outputs of the viewer must not replace its inputs.
#pragma once

#include "samples/viewer/options.hpp"
#include "samples/viewer/scene_file.hpp"
#include "voile/result.hpp"

#include <string>
#include <vector>

namespace viewer
{

// Errors: --video, --stats or --export names a file that --collider, the scene or another of them has, by whatever
// path. Devices and pipes may be given more than once. `scene`: a path, or a name.
voile::Result<void> check_outputs(const Options& options);
// The same for the meshes that the scene names, and for the files that several exported cloths and colliders get.
// `solids`: the names of the colliders.
voile::Result<void> check_outputs(const Options& options, const SceneFile& scene,
                                  const std::vector<std::string>& solids);

} // namespace viewer
