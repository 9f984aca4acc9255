// Controls: what keys and mouse do in the viewer's window.
#pragma once

#include "samples/viewer/frame_outputs.hpp"
#include "samples/viewer/grab.hpp"
#include "samples/viewer/loaded_scene.hpp"
#include "samples/viewer/picture_saver.hpp"

#include <functional>
#include <string>

namespace viewer
{

// A key or a gesture, and what it does. The help shows them.
struct ControlHelp
{
    const char* keys;
    const char* action;
};
std::span<const ControlHelp> control_help();

constexpr float k_slowest = 1.f / 16; // speed of time

class Controls
{
public:
    Controls(voile::engine::App& app, LoadedScene& scene);

    // The events of a frame, before it begins.
    void handle(const voile::engine::Input& input, float seconds);

    // Copies out of a frame that was just drawn, and what is to be done once the device has finished it.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame) { pictures_.record(cmd, frame); }
    void completed(const voile::engine::FrameInfo& frame);

    // Called when the run has started again, with another scene or with the same.
    std::function<void()> restarted;

    // True once if the next frame is to be captured.
    [[nodiscard]] bool take_capture() { return std::exchange(capture_, false); }

    // What the panel changes, too.
    bool paused = false;
    bool show_help = false;
    bool show_panel = true;
    float speed = 1; // of time, k_slowest..1

    void step() { ++steps_; }
    void show_all();
    void save_picture();
    void save_scene();
    void request_capture();
    // Each starts again at time 0. If it is not possible a message says why, and the run continues.
    void restart();
    void open_scene(const std::string& name);
    void add_colliders(const std::vector<std::filesystem::path>& files);
    // Starts again with these in place of those of their names. If that fails, the scene starts again as it was.
    voile::Result<void> use_cloth_shaders(const std::vector<voile::engine::ShaderCode>& shaders);

    // A line for the user, on standard output, too.
    void say(const std::string& text);
    [[nodiscard]] const std::string& message() const { return message_; }

private:
    void press(const voile::engine::KeyPress& key);
    [[nodiscard]] bool may_restart();
    void follow_mouse(const voile::engine::Input& input, float seconds);
    void started_again(const voile::Result<void>& done);
    void replace_scene(voile::Result<LoadedScene> next);
    void update_title();

    voile::engine::App& app_;
    LoadedScene& scene_;
    PictureSaver pictures_;
    Grab grab_;
    uint32_t steps_ = 0; // to take while paused
    bool capture_ = false;
    std::string message_;
    std::string title_;
};

} // namespace viewer
