// LoadedScene: a scene file with its solids, on stage. In a window another one takes its place.
#pragma once

#include "samples/viewer/debug_view.hpp"

namespace viewer
{

struct LoadedScene
{
    Options options;
    SceneFile file;
    std::vector<Solid> solids;
    Stage stage;
    DebugView* debug = nullptr; // owned by the scene; null: there is nothing to draw
};

// Reads the scene of the options and its meshes. Errors name the file and the position in it.
voile::Result<LoadedScene> load(const Options& options);

// Adds it to `app`, whose scene is empty. `loaded` must stay where it is: components refer to it. Errors name what the
// solver refuses.
voile::Result<void> set_up(voile::engine::App& app, LoadedScene& loaded);

// Starts again with `next` in place of `loaded`. If the solver refuses it, the former scene starts again. If it
// refuses both, StartupError.
voile::Result<void> replace(voile::engine::App& app, LoadedScene& loaded, LoadedScene next);

// Starts again with the scene as its file is now, and these options. Keeps the camera.
voile::Result<void> restart(voile::engine::App& app, LoadedScene& loaded, const Options& options);

// The scene file of what runs: with the resolution and the colliders of the options, and this camera.
SceneFile current_file(const LoadedScene& loaded, const voile::engine::Camera& camera);

} // namespace viewer
