// Loading a scene, and replacing one by another.
#include "samples/viewer/loaded_scene.hpp"

#include <algorithm>
#include <utility>

namespace viewer
{
namespace
{

voile::Result<void> load_meshes(LoadedScene& loaded)
{
    auto solids = load_solids(loaded.file, loaded.options);
    if (!solids)
        return solids.error();
    loaded.solids = std::move(solids.value());
    return {};
}

// A mesh that load_solids fitted into the scene: scaled and moved.
ColliderEntry entry_of(const Solid& solid)
{
    ColliderEntry entry;
    entry.shape = MeshShape{solid.file};
    entry.placed = true;
    entry.transform.translate = solid.transform[3];
    entry.transform.scale = solid.transform[0][0];
    entry.motion = solid.motion;
    entry.layers = solid.layers;
    return entry;
}

} // namespace

voile::Result<LoadedScene> load(const Options& options)
{
    LoadedScene loaded;
    loaded.options = options;
    const auto path = find_scene(options.scene);
    if (!path)
        return path.error();
    auto file = load_scene(path.value());
    if (!file)
        return file.error();
    loaded.file = std::move(file.value());
    if (const auto meshes = load_meshes(loaded); !meshes)
        return meshes.error();
    return loaded;
}

voile::Result<void> set_up(voile::engine::App& app, LoadedScene& loaded)
try
{
    auto stage = set_stage(app, loaded.file, loaded.solids, loaded.options);
    if (!stage)
        return stage.error();
    loaded.stage = std::move(stage.value());
    loaded.debug = nullptr;
    if (app.has_window() || loaded.options.debug.any())
        loaded.debug = &app.scene().add("debug").add<DebugView>(app, loaded.stage, loaded.solids, loaded.options.debug);
    return {};
}
catch (const voile::engine::StartupError& error) // of a component
{
    return voile::Error{error.what()};
}

voile::Result<void> replace(voile::engine::App& app, LoadedScene& loaded, LoadedScene next)
{
    app.restart();
    std::swap(loaded, next);
    auto done = set_up(app, loaded);
    if (done)
        return done;
    app.restart();
    std::swap(loaded, next);
    voile::engine::take(set_up(app, loaded));
    return done;
}

voile::Result<void> restart(voile::engine::App& app, LoadedScene& loaded, const Options& options)
{
    LoadedScene next;
    next.options = options;
    next.file = loaded.file;
    next.solids = loaded.solids;
    const voile::engine::Camera camera = app.scene().camera;
    auto done = replace(app, loaded, std::move(next));
    app.scene().camera = camera;
    return done;
}

SceneFile current_file(const LoadedScene& loaded, const voile::engine::Camera& camera)
{
    SceneFile file = loaded.file;
    file.camera = CameraEntry{camera.position, camera.target, camera.fov};
    for (ClothEntry& cloth : file.cloths)
        if (auto* grid = std::get_if<GridEntry>(&cloth.form); grid != nullptr && loaded.options.cloth_resolution)
            grid->columns = grid->rows = *loaded.options.cloth_resolution;
    std::erase_if(file.colliders,
                  [&](const ColliderEntry& entry)
                  {
                      return std::ranges::none_of(loaded.solids, [&](const Solid& solid)
                                                  { return solid.location.path == entry.location.path; });
                  });
    for (const Solid& solid : loaded.solids)
        if (!solid.file.empty())
            file.colliders.push_back(entry_of(solid));
    return file;
}

} // namespace viewer
