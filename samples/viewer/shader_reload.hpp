// ShaderReload: compiles the renderer's shaders when their files change, and keeps the last ones that work.
#pragma once

#include "voile/engine/render/renderer.hpp"

#include <chrono>
#include <filesystem>
#include <map>
#include <string>

namespace viewer
{

class ShaderReload
{
public:
    // Watches a folder with the files of shaders/render, and compiles them at once. StartupError if it lacks one.
    ShaderReload(voile::engine::Renderer& renderer, std::filesystem::path folder);

    // Between frames: looks for changes, four times per second at most, and compiles.
    void update();

    // What is wrong with the files as they are, a line per error; empty: the picture shows them.
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

    voile::engine::Renderer& renderer_;
    std::filesystem::path folder_;
    FolderState state_;
    std::map<std::string, std::vector<uint32_t>> shown_; // SPIR-V that the renderer has
    std::string errors_;
    Clock::time_point next_{};
};

} // namespace viewer
