// Controls.
#include "samples/viewer/controls.hpp"

#include "samples/viewer/scene_writer.hpp"

#include "voile/engine/app/camera_control.hpp"
#include "voile/gpu/printable.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace viewer
{
namespace
{

using voile::engine::Key;

constexpr auto k_help = std::to_array<ControlHelp>({
    {"left drag on the cloth", "pull at it"},
    {"left drag beside it, on a solid, or with Alt", "orbit"},
    {"middle drag, shift + left drag", "pan"},
    {"wheel", "zoom"},
    {"right drag", "look around; with W A S D Q E fly, with shift faster"},
    {"F, Home", "show everything"},
    {"space", "pause and continue"},
    {".", "one step, while paused"},
    {"R", "start again at time 0"},
    {"Tab", "show and hide the panel"},
    {"F1", "this help"},
    {"F2", "save the picture as PNG"},
    {"control + S", "save the scene as JSON"},
    {"a file dropped onto the window", "an OBJ or PLY becomes a collider, as --collider does"},
    {"F12", "RenderDoc capture (start with --capture key)"},
    {"Esc", "close"},
});

constexpr const char* k_records = "a run that writes its frames does not start again";

// Files that hold every frame of a run cannot start again.
bool records(const Options& options)
{
    return options.out || options.video || is_animated(options);
}

// Where files go that the user asks for.
std::filesystem::path folder_of(const Options& options)
{
    return options.out.value_or(".");
}

} // namespace

std::span<const ControlHelp> control_help()
{
    return k_help;
}

Controls::Controls(voile::engine::App& app, LoadedScene& scene)
    : paused(scene.options.paused), app_(app), scene_(scene), pictures_(app), grab_(app, scene.stage, scene.solids)
{
}

void Controls::handle(const voile::engine::Input& input, float seconds)
{
    for (const voile::engine::KeyPress& key : input.keys)
        press(key);
    if (!input.dropped.empty())
        add_colliders(input.dropped);
    follow_mouse(input, seconds);
    const float time_step = speed / scene_.file.step.rate;
    if (time_step != app_.time_step())
        app_.set_time_step(time_step);
    app_.set_simulating(!paused || steps_ > 0);
    steps_ -= steps_ > 0 ? 1 : 0;
    update_title();
}

// The left button pulls at the cloth where it was pressed on it, and else steers.
void Controls::follow_mouse(const voile::engine::Input& input, float seconds)
{
    if (input.left.pressed && !input.shift && !input.alt)
        (void)grab_.begin(input.left.at);
    grab_.move(input.cursor);
    if (!input.left.held)
        grab_.end();
    voile::engine::steer(app_.scene().camera, input, seconds, app_.scene().focus_radius, !grab_.active());
}

void Controls::press(const voile::engine::KeyPress& key)
{
    if (key.key == Key::period && paused) // repeats while it is held
        step();
    if (key.repeated)
        return;
    switch (key.key)
    {
    case Key::space:
        paused = !paused;
        break;
    case Key::r:
        restart();
        break;
    case Key::f:
    case Key::home:
        show_all();
        break;
    case Key::s:
        if (key.control)
            save_scene();
        break;
    case Key::tab:
        show_panel = !show_panel;
        break;
    case Key::f1:
        show_help = !show_help;
        break;
    case Key::f2:
        save_picture();
        break;
    case Key::f12:
        request_capture();
        break;
    case Key::escape:
        app_.window()->close();
        break;
    default:
        break;
    }
}

void Controls::completed(const voile::engine::FrameInfo& frame)
{
    const auto written = pictures_.write(frame);
    if (!written)
        say(written.error().message);
    else if (written.value())
        say("wrote " + written_name(*written.value()));
}

void Controls::show_all()
{
    const VkExtent2D extent = app_.renderer().extent();
    voile::engine::show_all(app_.scene().camera, app_.scene().focus, app_.scene().focus_radius,
                            static_cast<float>(extent.width) / static_cast<float>(extent.height));
}

void Controls::save_picture()
{
    pictures_.request(unused_path(folder_of(scene_.options), scene_.file.name, ".png"));
}

void Controls::save_scene()
{
    const std::filesystem::path path = unused_path(folder_of(scene_.options), scene_.file.name, ".json");
    const auto saved = viewer::save_scene(current_file(scene_, app_.scene().camera), path);
    say(saved ? "wrote " + written_name(path) : saved.error().message);
}

void Controls::request_capture()
{
    if (scene_.options.capture_key)
        capture_ = true;
    else
        say("captures need RenderDoc from the start: run the viewer with --capture key");
}

bool Controls::may_restart()
{
    if (records(scene_.options))
        say(k_records);
    return !records(scene_.options);
}

void Controls::restart()
{
    if (!may_restart())
        return;
    started_again(viewer::restart(app_, scene_, scene_.options));
}

voile::Result<void> Controls::use_cloth_shaders(const std::vector<voile::engine::ShaderCode>& shaders)
{
    if (records(scene_.options))
        return voile::Error{k_records};
    Options options = scene_.options;
    for (const voile::engine::ShaderCode& shader : shaders)
    {
        std::erase_if(options.cloth_shaders, [&](const auto& former) { return former.name == shader.name; });
        options.cloth_shaders.push_back(shader);
    }
    auto done = viewer::restart(app_, scene_, options);
    started_again({});
    return done;
}

void Controls::started_again(const voile::Result<void>& done)
{
    grab_.forget();
    if (!done)
        say(done.error().message);
    if (restarted)
        restarted();
}

void Controls::replace_scene(voile::Result<LoadedScene> next)
{
    if (!next)
        return say(next.error().message);
    started_again(replace(app_, scene_, std::move(next.value())));
}

void Controls::open_scene(const std::string& name)
{
    if (!may_restart())
        return;
    Options options = scene_.options;
    options.scene = name;
    options.colliders.clear();
    replace_scene(load(options));
}

void Controls::add_colliders(const std::vector<std::filesystem::path>& files)
{
    if (!may_restart())
        return;
    Options options = scene_.options;
    options.colliders.insert(options.colliders.end(), files.begin(), files.end());
    LoadedScene next;
    next.options = options;
    next.file = scene_.file;
    auto solids = load_solids(next.file, options);
    if (!solids)
        return say(solids.error().message);
    next.solids = std::move(solids.value());
    replace_scene(std::move(next));
}

void Controls::say(const std::string& text)
{
    constexpr size_t k_longest = 400; // bytes
    message_ = voile::gpu::printable(text, k_longest);
    std::printf("%s\n", message_.c_str());
    std::fflush(stdout);
}

void Controls::update_title()
{
    std::string title = "voile: " + scene_.file.name;
    if (paused)
        title += " (paused at frame " + std::to_string(app_.frame_count()) + ")";
    if (title != title_)
        app_.window()->set_title(title);
    title_ = title;
}

} // namespace viewer
