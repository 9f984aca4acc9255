// What the viewer writes must not take the place of what it reads.
#pragma once

#include "gpu/result.hpp"
#include "samples/viewer/options.hpp"
#include "samples/viewer/scene_file.hpp"

namespace viewer
{

// Errors: --video, --stats or --export names a file that --collider, the scene or another of them has, by whatever
// path. Devices and pipes may be given more than once. `scene`: a path, or a name.
gpu::Result<void> check_outputs(const Options& options);
// Likewise for the meshes that the scene names.
gpu::Result<void> check_outputs(const Options& options, const SceneFile& scene);

} // namespace viewer
