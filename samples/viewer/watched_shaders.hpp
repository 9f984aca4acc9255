// WatchedShaders: the folder of --shaders, for the picture and for the cloth.
#pragma once

#include "samples/viewer/shader_reload.hpp"

#include <optional>

namespace voile::engine
{
class App;
}

namespace viewer
{

class Controls;
struct Options;

class WatchedShaders
{
public:
    // The folder of the options is one of render shaders, or has `render` and `cloth`. Compiles those of the cloth into
    // the options, which are borrowed. Without a folder nothing is watched. StartupError: a shader is missing.
    explicit WatchedShaders(Options& options);

    // Once the scene is on stage. Compiles the render shaders, and from now on what changes: those of the cloth only in
    // a window, because the scene starts again. All are borrowed.
    void connect(voile::engine::App& app, Controls& controls);

    // What is wrong with the files as they are, a line per error; empty: they are in use.
    [[nodiscard]] std::string errors() const;

private:
    Options& options_;
    std::filesystem::path render_folder_;
    std::optional<ShaderReload> render_;
    std::optional<ShaderReload> cloth_;
};

} // namespace viewer
