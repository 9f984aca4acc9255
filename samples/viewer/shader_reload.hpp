// ShaderReload: compiles the shaders of a folder when their files change. The last ones that work stay.
#pragma once

#include "voile/engine/render/renderer.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace viewer
{

class ShaderReload
{
public:
    // Shaders whose code has changed, named without their folders: takes all of them, or none and says why.
    using Take = std::function<voile::Result<void>(const std::vector<voile::engine::ShaderCode>&)>;

    // Watches `folder`, where includes are searched, too, and compiles `files` (in it) at once. StartupError if it
    // lacks one.
    ShaderReload(std::filesystem::path folder, std::vector<std::filesystem::path> files, Take take);

    // Between frames: looks for changes, four times per second at most, and compiles.
    void update();

    // Who takes what will be compiled.
    Take take;

    // What is wrong with the files as they are, a line per error; empty: they are in use.
    [[nodiscard]] const std::string& errors() const { return errors_; }

private:
    using Clock = std::chrono::steady_clock;
    struct FileState
    {
        std::filesystem::file_time_type time;
        uintmax_t size = 0;
        bool operator==(const FileState&) const = default;
    };
    using FolderState = std::map<std::filesystem::path, FileState>;

    [[nodiscard]] FolderState look() const;
    void compile();
    void report(const std::string& errors);

    std::filesystem::path folder_;
    std::vector<std::filesystem::path> files_;
    FolderState state_;
    std::map<std::string, std::vector<uint32_t>> taken_; // SPIR-V by name
    std::string errors_;
    Clock::time_point next_{};
};

} // namespace viewer
