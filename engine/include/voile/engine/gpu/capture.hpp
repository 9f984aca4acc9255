// Capture: RenderDoc frame captures through its in-application interface, headless too.
#pragma once

#include <string>

namespace voile::engine
{

// Load before the Vulkan instance is made: RenderDoc can only see instances made after it is loaded.
class Capture
{
public:
    // `path_template`: where captures go, without extension. StartupError naming what to install if RenderDoc is not
    // there.
    explicit Capture(const std::string& path_template);

    void begin();
    // The path of the .rdc file. StartupError if RenderDoc wrote none.
    std::string end();

private:
    void* api_ = nullptr;
};

} // namespace voile::engine
