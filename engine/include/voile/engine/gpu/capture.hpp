// Capture: RenderDoc frame captures through its in-application interface, headless too.
#pragma once

#include <string>

namespace voile::engine
{

// Load before the Vulkan instance is made: RenderDoc can only see instances made after it is loaded.
class Capture
{
public:
    // `path_template`: the path of captures, without extension. StartupError if RenderDoc is missing; it names the
    // package to install.
    explicit Capture(const std::string& path_template);

    void begin();
    // The path of the .rdc file. StartupError if RenderDoc wrote none.
    std::string end();

private:
    void* api_ = nullptr;
};

} // namespace voile::engine
