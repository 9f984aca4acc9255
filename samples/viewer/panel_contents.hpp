// The contents of the panel, one function per section. Called between ImGui::NewFrame and ImGui::Render.
#pragma once

#include "samples/viewer/controls.hpp"
#include "samples/viewer/frame_history.hpp"
#include "samples/viewer/watched_shaders.hpp"

namespace viewer
{

struct PanelContents
{
    voile::engine::App& app;
    LoadedScene& scene;
    Controls& controls;
    const WatchedShaders& shaders;
    FrameHistory history{};
    float frame_seconds = 0; // between the last two frames, smoothed
    std::vector<std::string> scene_names{};
};

void show_run(PanelContents& panel); // pause, step, speed, scenes
void show_times(const PanelContents& panel);
void show_views(PanelContents& panel);
void show_materials(PanelContents& panel);
void show_step(PanelContents& panel); // wind and step
void show_help(bool& open);

} // namespace viewer
