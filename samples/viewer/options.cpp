#include "samples/viewer/options.hpp"

#include "samples/viewer/output_check.hpp"
#include "samples/viewer/scene_file.hpp"
#include "samples/viewer/text.hpp"

#include "voile/gpu/printable.hpp"
#include "voile/version.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <exception>
#include <memory>
#include <string_view>
#include <utility>

namespace viewer
{
namespace
{

namespace fs = std::filesystem;

constexpr size_t k_longest_reason = 200;        // bytes, of words that are not ours
constexpr uint32_t k_largest_side = 16384;      // pixels
constexpr uint32_t k_deepest_box = 48;          // the deepest level of a hierarchy
constexpr uint32_t k_most_frames = 100'000'000; // 19 days of simulated time

// CLI11 would write "[scene(0x)]", because of its setting for repetitions.
class Formatter : public CLI::Formatter
{
public:
    std::string make_usage(const CLI::App*, std::string name) const override
    {
        return "\nUsage: " + name + " [options] [SCENE.json|NAME]\n";
    }
};

// Options as they were typed. They are converted after CLI11 is done, so that every message is worded here.
struct Typed
{
    std::vector<std::string> scenes;
    std::vector<std::string> frames, size, out, every, video, stats, exports, resolution, colliders, device, capture,
        debug, shaders;
};

constexpr const char* k_description = "Simulates cloth on the GPU and shows it, in a window or as files.";

constexpr const char* k_footer = R"(
Exit codes: 0 done; 1 bad input or no device; 2 validation messages, or values that are not finite.
Ctrl-C finishes all files with the frames so far; a second one ends at once.

Examples:
  viewer                                              the reference scene in a window
  viewer drape --cloth-resolution 256                 a finer cloth
  viewer flag --headless --frames 600 --video flag.mp4
  viewer my_scene.json --headless --stats run.json --export cloth.obj
  viewer drape --collider bunny.obj --headless --out frames --every 10
  viewer curtains --headless --frames 240 --export curtains.usda
)";

void declare_simulation(CLI::App& app, Typed& typed, Options& options)
{
    app.add_option("scene", typed.scenes, "A scene file, or the name of a scene that ships (default: reference)")
        ->type_name("SCENE.json|NAME")
        ->expected(0, 1000000); // more than one is refused by us, by name
    app.add_flag("--headless", options.headless, "No window; the default where there is no display")
        ->disable_flag_override();
    app.add_option("--frames", typed.frames,
                   "Frames to simulate, as many per second as the scene's step says, else 60 (default: 300 without a "
                   "window, unlimited with one)")
        ->type_name("N");
    app.add_flag("--paused", options.paused, "The window opens paused: space continues, a period takes one step")
        ->disable_flag_override();
    app.add_option("--cloth-resolution", typed.resolution,
                   "Gives every grid of the scene N x N vertices (default: the scene's)")
        ->type_name("N");
    app.add_option("--collider", typed.colliders,
                   "Puts a mesh where the scene's meshes stand, fitted to their box; repeatable")
        ->type_name("FILE.obj|.ply");
}

void declare_output(CLI::App& app, Typed& typed, Options& options)
{
    const char* group = "Output";
    app.add_option("--size", typed.size, "Size of the pictures in pixels (default: 1280x720)")
        ->type_name("WxH")
        ->group(group);
    app.add_option("--out", typed.out, "Writes the frames as PNG files into this folder")
        ->type_name("DIR")
        ->group(group);
    app.add_option("--every", typed.every, "Writes each K-th PNG frame only (default: 1)")
        ->type_name("K")
        ->group(group);
    app.add_option("--video", typed.video, "Writes a film; needs ffmpeg")->type_name("FILE.mp4")->group(group);
    app.add_option("--stats", typed.stats, "Writes statistics")->type_name("FILE.json")->group(group);
    app.add_option("--export", typed.exports,
                   "Writes the last state as OBJ or PLY, or the start and every frame as a PC2 point\n"
                   "cache, one file per cloth, with its name added when there are several; or all of\n"
                   "them with the colliders as USD; repeatable")
        ->type_name("FILE.obj|.ply|.pc2|.usda")
        ->group(group);
    app.add_flag("--export-colliders", options.export_colliders,
                 "Colliders as OBJ and PLY, too, and as PC2 those that move")
        ->disable_flag_override()
        ->group(group);
    app.add_option("--debug", typed.debug,
                   "Draws over the picture the boxes of the meshes' hierarchies (level 4 where\n"
                   "none is named), the vertices in contact, the vertex normals, or the vertices of\n"
                   "intersecting edges and triangles, which it also counts each frame, or colors fabric\n"
                   "by its stretch, red at PERCENT (5 where none is named); repeatable")
        ->type_name("boxes[:LEVEL]|contacts|normals|intersections|strain[:PERCENT]")
        ->group(group);
    app.add_option("--shaders", typed.shaders,
                   "Draws and simulates with the shaders of this folder (shaders, or a copy; or the\n"
                   "render shaders alone), and compiles them when their files change; needs\nglslangValidator")
        ->type_name("DIR")
        ->group(group);
    app.add_flag("--verify", options.verify,
                 "Adds exact checks of the final state to the statistics:\npenetration and intersections")
        ->disable_flag_override()
        ->group(group);
}

void declare_device(CLI::App& app, Typed& typed, Options& options)
{
    const char* group = "Device";
    app.add_option("--device", typed.device, "The device (default: a discrete GPU, else what there is)")
        ->type_name("INDEX|NAME")
        ->group(group);
    app.add_flag("--list-devices", options.list_devices, "Lists the devices and leaves")
        ->disable_flag_override()
        ->group(group);
    app.add_flag("--validate", options.validate,
                 "Validation and synchronization validation; any message makes the exit code 2")
        ->disable_flag_override()
        ->group(group);
    app.add_option("--capture", typed.capture, "A RenderDoc capture of that frame, or in the window with F12")
        ->type_name("FRAME|key")
        ->group(group);
}

// Reports the first problem; later calls do nothing.
class Converter
{
public:
    std::optional<std::string> error;

    void fail(const char* option, const std::string& reason)
    {
        if (!error)
            error = std::string(option) + ": " + reason;
    }

    // The one value of an option, if it was given.
    std::optional<std::string> single(const char* option, const std::vector<std::string>& values)
    {
        if (values.empty())
            return std::nullopt;
        if (values.size() > 1)
            fail(option, "given " + std::to_string(values.size()) + " times; once at most");
        check_value(option, values.front());
        return values.front();
    }

    void check_value(const char* option, const std::string& value)
    {
        if (value.empty())
            fail(option, "the value is empty");
        else if (value.starts_with("--"))
            fail(option, "a value is missing before " + in_quotes(value));
    }

    std::optional<uint32_t> integer(const char* option, const std::vector<std::string>& values, uint32_t min,
                                    uint32_t max)
    {
        const std::optional<std::string> text = single(option, values);
        if (!text)
            return std::nullopt;
        long long value = 0;
        const char* end = text->data() + text->size();
        const auto [stop, problem] = std::from_chars(text->data(), end, value);
        const bool number = stop == end && problem != std::errc::invalid_argument;
        if (!number)
            fail(option, in_quotes(*text) + " is not a whole number");
        else if (problem != std::errc{} || value < min || value > max)
            fail(option, in_quotes(*text) + " is not within " + std::to_string(min) + " to " + std::to_string(max));
        return static_cast<uint32_t>(value);
    }

    std::optional<fs::path> path(const char* option, const std::vector<std::string>& values)
    {
        const std::optional<std::string> text = single(option, values);
        return text ? std::optional<fs::path>(*text) : std::nullopt;
    }
};

void convert_size(Converter& convert, const std::vector<std::string>& values, Options& options)
{
    const std::optional<std::string> text = convert.single("--size", values);
    if (!text)
        return;
    const char* end = text->data() + text->size();
    uint32_t width = 0;
    uint32_t height = 0;
    const auto first = std::from_chars(text->data(), end, width);
    const bool cross = first.ptr != end && (*first.ptr == 'x' || *first.ptr == 'X');
    const auto second = cross ? std::from_chars(first.ptr + 1, end, height) : first;
    const auto no_number = std::errc::invalid_argument;
    if (!cross || first.ec == no_number || second.ec == no_number || second.ptr != end)
        return convert.fail("--size", in_quotes(*text) + " is not WIDTHxHEIGHT");
    // Too large for an integer is out of range as well: from_chars leaves the number as it was, zero.
    if (std::min(width, height) < 1 || std::max(width, height) > k_largest_side)
        return convert.fail("--size", in_quotes(*text) + " is not within 1x1 to 16384x16384");
    options.width = width;
    options.height = height;
}

void convert_exports(Converter& convert, const std::vector<std::string>& values, Options& options)
{
    constexpr std::pair<const char*, ExportFormat> k_formats[] = {{".obj", ExportFormat::obj},
                                                                  {".ply", ExportFormat::ply},
                                                                  {".pc2", ExportFormat::point_cache},
                                                                  {".usda", ExportFormat::usd}};
    for (const std::string& value : values)
    {
        convert.check_value("--export", value);
        const std::string extension = lower_extension(value);
        const auto format = std::ranges::find_if(k_formats, [&](const auto& f) { return extension == f.first; });
        if (format == std::end(k_formats))
            convert.fail("--export", path_in_quotes(value) + " does not end in .obj, .ply, .pc2 or .usda" +
                                         suggestion(extension, {".obj", ".ply", ".pc2", ".usda"}));
        else
            options.exports.push_back({value, format->second});
    }
}

void convert_colliders(Converter& convert, const std::vector<std::string>& values, Options& options)
{
    for (const std::string& value : values)
    {
        convert.check_value("--collider", value);
        const std::string extension = lower_extension(value);
        std::error_code problem;
        if (extension != ".obj" && extension != ".ply")
            convert.fail("--collider", path_in_quotes(value) + " does not end in .obj or .ply");
        else if (!fs::exists(value, problem))
            convert.fail("--collider",
                         path_in_quotes(value) + (problem ? ": " + problem.message() : " does not exist"));
        else if (fs::is_directory(value, problem))
            convert.fail("--collider", path_in_quotes(value) + " is a folder");
        options.colliders.emplace_back(value);
    }
}

void convert_debug(Converter& convert, const std::vector<std::string>& values, DebugOptions& debug)
{
    constexpr uint32_t k_boxes_level = 4;
    constexpr uint32_t k_strain = 5; // percent
    constexpr uint32_t k_most_strain = 100;
    const std::string boxes = "boxes:";
    const std::string strain = "strain:";
    for (const std::string& value : values)
    {
        convert.check_value("--debug", value);
        if (value == "contacts")
            debug.contacts = true;
        else if (value == "normals")
            debug.normals = true;
        else if (value == "intersections")
            debug.intersections = true;
        else if (value == "boxes")
            debug.boxes = k_boxes_level;
        else if (value.starts_with(boxes))
            debug.boxes = convert.integer("--debug boxes", {value.substr(boxes.size())}, 0, k_deepest_box);
        else if (value == "strain")
            debug.strain = k_strain;
        else if (value.starts_with(strain))
            debug.strain = convert.integer("--debug strain", {value.substr(strain.size())}, 1, k_most_strain);
        else
            convert.fail("--debug",
                         in_quotes(value) +
                             " is not boxes, boxes:LEVEL, contacts, normals, intersections, strain or strain:PERCENT" +
                             suggestion(value, {"boxes", "contacts", "normals", "intersections", "strain"}));
    }
}

void check_together(Converter& convert, const Typed& typed, const Options& options)
{
    if (!typed.every.empty() && !options.out)
        convert.fail("--every", "has no effect without --out");
    if (options.export_colliders && options.exports.empty())
        convert.fail("--export-colliders", "has no effect without --export");
    if (options.paused && options.headless)
        convert.fail("--paused", "has no effect with --headless");
    if (options.capture_key && options.headless)
        convert.fail("--capture key", "has no effect with --headless");
    if (options.capture && (options.frames || options.headless))
    {
        if (const auto frames = headless_frames(options); !frames && !convert.error)
            convert.error = frames.error().message;
    }
}

voile::Result<Options> convert_all(const Typed& typed, Options options)
{
    Converter convert;
    if (typed.scenes.size() > 1)
        return voile::Error{in_quotes(typed.scenes[1]) + ": one scene at most, and " + in_quotes(typed.scenes[0]) +
                            " was given before it"};
    if (!typed.scenes.empty())
        options.scene = typed.scenes.front();
    if (options.scene.empty())
        return voile::Error{"the scene's name is empty"};
    options.frames = convert.integer("--frames", typed.frames, 0, k_most_frames);
    convert_size(convert, typed.size, options);
    options.out = convert.path("--out", typed.out);
    options.every = convert.integer("--every", typed.every, 1, k_most_frames).value_or(1);
    options.video = convert.path("--video", typed.video);
    if (options.video && lower_extension(*options.video) != ".mp4")
        convert.fail("--video", path_in_quotes(*options.video) + " does not end in .mp4");
    options.stats = convert.path("--stats", typed.stats);
    convert_exports(convert, typed.exports, options);
    options.cloth_resolution =
        convert.integer("--cloth-resolution", typed.resolution, k_least_grid_vertices, k_most_grid_vertices);
    convert_colliders(convert, typed.colliders, options);
    options.device = convert.single("--device", typed.device);
    options.capture_key = typed.capture == std::vector<std::string>{"key"};
    if (!options.capture_key)
        options.capture = convert.integer("--capture", typed.capture, 0, k_most_frames);
    convert_debug(convert, typed.debug, options.debug);
    options.shaders = convert.path("--shaders", typed.shaders);
    check_together(convert, typed, options);
    if (convert.error)
        return voile::Error{*convert.error};
    if (auto result = check_outputs(options); !result)
        return result.error();
    return options;
}

// CLI11's own words run over several lines and do not always name the value.
voile::Error word_parse_error(const CLI::App& app, const CLI::ParseError& problem)
{
    const std::string text = problem.what();
    if (dynamic_cast<const CLI::ExtrasError*>(&problem) != nullptr)
    {
        const std::vector<std::string> rest = app.remaining();
        const std::string word = rest.empty() ? "" : rest.front().substr(0, rest.front().find('='));
        std::vector<std::string> known;
        for (const CLI::Option* option : app.get_options())
        {
            for (const std::string& name : option->get_lnames())
                known.push_back("--" + name);
        }
        return voile::Error{voile::gpu::printable(word) + ": unknown option" + suggestion(word, known)};
    }
    const bool mismatch = dynamic_cast<const CLI::ArgumentMismatch*>(&problem) != nullptr;
    if (mismatch && text.find("disallowed flag override") != std::string::npos)
        return voile::Error{"--" + voile::gpu::printable(text.substr(0, text.find(' '))) + ": takes no value"};
    const std::string option = text.substr(0, text.find(':'));
    if (mismatch && option.starts_with("--"))
        return voile::Error{voile::gpu::printable(option) + ": a value is missing"};
    return voile::Error{voile::gpu::printable(text, k_longest_reason)};
}

voile::Result<Options> parse(int argument_count, const char* const* arguments)
{
    CLI::App app(k_description, "viewer");
    app.footer(k_footer);
    app.formatter(std::make_shared<Formatter>());
    app.get_formatter()->column_width(34);
    app.set_version_flag("--version", "viewer " VOILE_VERSION_STRING, "Prints the version and leaves");
    app.set_help_flag("-h,--help", "Prints this help and leaves");
    app.option_defaults()->take_all(); // repetition is ours to refuse
    Typed typed;
    Options options;
    declare_simulation(app, typed, options);
    declare_output(app, typed, options);
    declare_device(app, typed, options);
    for (CLI::Option* option : app.get_options())
    {
        // One value a mention: otherwise "--out frames drape" would swallow the scene.
        if (!option->get_lnames().empty() && option->get_items_expected_max() > 0)
            option->expected(1)->allow_extra_args(false);
    }
    try
    {
        app.parse(argument_count, arguments);
    }
    catch (const CLI::CallForHelp&)
    {
        options.message = app.help();
        return options;
    }
    catch (const CLI::CallForVersion& version)
    {
        options.message = std::string(version.what()) + "\n";
        return options;
    }
    catch (const CLI::ParseError& problem)
    {
        return word_parse_error(app, problem);
    }
    return convert_all(typed, std::move(options));
}

} // namespace

voile::Result<uint32_t> headless_frames(const Options& options)
{
    const uint32_t frames = options.frames.value_or(k_headless_frames);
    if (options.capture && *options.capture >= frames)
        return voile::Error{"--capture: \"" + std::to_string(*options.capture) + "\" is beyond the last of " +
                            std::to_string(frames) + " frames, counted from 0"};
    return frames;
}

bool is_animated(const Options& options)
{
    return std::ranges::any_of(options.exports, [](const ExportTarget& target) { return is_animation(target.format); });
}

voile::Result<Options> parse_options(int argument_count, const char* const* arguments)
{
    try
    {
        return parse(argument_count, arguments);
    }
    catch (const std::exception& problem) // CLI11 throws while options are declared, too
    {
        return voile::Error{voile::gpu::printable(problem.what(), k_longest_reason)};
    }
}

} // namespace viewer
