#include "samples/viewer/watched_shaders.hpp"

#include "samples/viewer/controls.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;
using Shaders = std::vector<voile::engine::ShaderCode>;

std::vector<fs::path> render_shaders()
{
    const auto names = voile::engine::shader_names();
    return {names.begin(), names.end()};
}

std::vector<fs::path> compute_shaders(const fs::path& folder)
{
    std::vector<fs::path> files;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, problem))
        if (entry.path().extension() == ".comp")
            files.push_back(fs::relative(entry.path(), folder));
    std::ranges::sort(files);
    return files;
}

} // namespace

WatchedShaders::WatchedShaders(Options& options) : options_(options)
{
    if (!options.shaders)
        return;
    const bool has_parts = fs::is_directory(*options.shaders / "render");
    render_folder_ = has_parts ? *options.shaders / "render" : *options.shaders;
    const fs::path cloth = *options.shaders / "cloth";
    if (!has_parts || !fs::is_directory(cloth))
        return;
    cloth_.emplace(cloth, compute_shaders(cloth),
                   [this](const Shaders& shaders)
                   {
                       options_.cloth_shaders = shaders;
                       return voile::Result<void>();
                   });
}

void WatchedShaders::connect(voile::engine::App& app, Controls& controls)
{
    if (!options_.shaders)
        return;
    render_.emplace(render_folder_, render_shaders(),
                    [&app](const Shaders& shaders) { return app.renderer().replace_shaders(shaders); });
    if (cloth_)
        cloth_->take = [&controls](const Shaders& shaders) { return controls.use_cloth_shaders(shaders); };
    app.before_frame = [this, in_window = app.has_window()]
    {
        render_->update();
        if (cloth_ && in_window)
            cloth_->update();
    };
}

std::string WatchedShaders::errors() const
{
    std::string errors = render_ ? render_->errors() : "";
    if (cloth_ && !cloth_->errors().empty())
        errors += (errors.empty() ? "" : "\n") + cloth_->errors();
    return errors;
}

} // namespace viewer
