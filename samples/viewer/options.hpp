// The viewer's command line.
#pragma once

#include "voile/engine/render/renderer.hpp"
#include "voile/result.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace viewer
{

constexpr uint32_t k_headless_frames = 300; // where --frames is not given

enum class ExportFormat
{
    obj, // the last state
    ply,
    point_cache, // every frame, as the next
    usd
};

constexpr bool is_animation(ExportFormat format)
{
    return format == ExportFormat::point_cache || format == ExportFormat::usd;
}

struct ExportTarget
{
    std::filesystem::path path;
    ExportFormat format = ExportFormat::obj;
};

// What is drawn over the picture.
struct DebugOptions
{
    std::optional<uint32_t> boxes{}; // a level of the hierarchies of mesh colliders, 0..48
    bool contacts = false;
    bool normals = false;
    bool intersections = false;
    std::optional<uint32_t>
        strain{}; // percent of the hottest color, 1..100; not drawn by DebugView but by the renderer

    [[nodiscard]] bool any() const { return boxes || contacts || normals || intersections; }
};

struct Options
{
    std::string scene = "reference"; // a path or a name: see find_scene
    bool headless = false;
    std::optional<uint32_t> frames{}; // absent: 300 without a window, no end with one
    uint32_t width = 1280;            // pixels, 1..16384
    uint32_t height = 720;
    std::optional<std::filesystem::path> out{}; // folder of the PNG frames
    uint32_t every = 1;                         // PNG frames are written for 0, every, 2 every, ...
    std::optional<std::filesystem::path> video{};
    std::optional<std::filesystem::path> stats{};
    std::vector<ExportTarget> exports{};
    bool export_colliders = false;                  // as OBJ, PLY and PC2; USD always has them
    std::optional<uint32_t> cloth_resolution{};     // 2..8192
    std::vector<std::filesystem::path> colliders{}; // files that exist, .obj or .ply
    std::optional<std::string> device{};            // an index or (a part of) a name
    bool list_devices = false;
    bool validate = false;
    std::optional<uint32_t> capture{}; // frame, from 0
    bool capture_key = false;          // F12 in the window captures a frame
    bool paused = false;               // the window opens paused
    bool verify = false;
    std::optional<std::filesystem::path> shaders{}; // a folder that is watched
    // What was compiled from it in place of the cloth's own; without folders in the names. No option has it.
    std::vector<voile::engine::ShaderCode> cloth_shaders{};
    DebugOptions debug{};

    // Not empty: print this on standard output and leave with exit code 0 (--help, --version).
    std::string message{};
};

// Whether an export holds every frame.
bool is_animated(const Options& options);

// Errors are one line that names the option, the value and the reason, without the program's name.
voile::Result<Options> parse_options(int argument_count, const char* const* arguments);

// The number of frames of a run without a window. An error if --capture asks for one beyond it, which parse_options
// can only see where --frames or --headless was given.
voile::Result<uint32_t> headless_frames(const Options& options);

} // namespace viewer
