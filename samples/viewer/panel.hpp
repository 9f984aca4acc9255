// Panel: the user interface over the picture. Without Dear ImGui it shows nothing.
#pragma once

#include "samples/viewer/controls.hpp"
#include "samples/viewer/watched_shaders.hpp"

#include <memory>

namespace viewer
{

class Panel
{
public:
    Panel(voile::engine::App& app, LoadedScene& scene, Controls& controls, const WatchedShaders& shaders);
    ~Panel();
    Panel(const Panel&) = delete;
    Panel& operator=(const Panel&) = delete;

    // Builds the next frame's panel. What it uses of the user's input it takes out of `input`.
    void update(voile::engine::Input& input, float seconds);

    // Draws it over the renderer's picture.
    void record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame);

    // Takes the measurements of a frame that the device has finished.
    void completed(const voile::engine::FrameInfo& frame);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace viewer
