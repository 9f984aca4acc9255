// The panel's sections on the run: what is shown, and how long it takes.
#include "samples/viewer/panel_contents.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace viewer
{
namespace
{

constexpr auto k_colors =
    std::to_array<ImU32>({IM_COL32(86, 156, 214, 255), IM_COL32(220, 120, 90, 255), IM_COL32(120, 190, 110, 255),
                          IM_COL32(215, 186, 90, 255), IM_COL32(170, 130, 200, 255), IM_COL32(90, 190, 190, 255),
                          IM_COL32(230, 160, 180, 255)});
constexpr ImU32 k_rest_color = IM_COL32(120, 120, 120, 255);

// The time of all passes over the last frames, in one column per frame, and a legend.
void plot_passes(const FrameHistory& history)
{
    const auto& samples = history.samples();
    const std::vector<size_t> passes = history.longest(k_colors.size());
    const float most = history.usual_most();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, 80};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(0, 0, 0, 110));
    const float width = size.x / static_cast<float>(FrameHistory::k_frames);
    for (size_t i = 0; i < samples.size(); ++i)
    {
        const float x = corner.x + width * static_cast<float>(i);
        float y = corner.y + size.y;
        const auto stack = [&](float milliseconds, ImU32 color)
        {
            const float height = std::clamp(size.y * milliseconds / most, 0.f, y - corner.y);
            list.AddRectFilled({x, y - height}, {x + width, y}, color);
            y -= height;
        };
        float rest = samples[i].frame_ms;
        for (size_t k = 0; k < passes.size(); ++k)
        {
            const float milliseconds = passes[k] < samples[i].passes_ms.size() ? samples[i].passes_ms[passes[k]] : 0.f;
            stack(milliseconds, k_colors[k]);
            rest -= milliseconds;
        }
        stack(std::max(rest, 0.f), k_rest_color);
    }
    ImGui::Dummy(size);
    ImGui::Text("GPU time per frame, up to %.4g ms; means:", static_cast<double>(most));
    for (size_t k = 0; k < passes.size(); ++k)
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(k_colors[k]), "%.3f ms %s",
                           static_cast<double>(history.mean(passes[k])), history.names()[passes[k]].c_str());
}

void show_plots(const FrameHistory& history)
{
    if (history.samples().empty())
        return ImGui::TextUnformatted("no frame was measured yet");
    plot_passes(history);
    const auto energy = [](void* data, int i)
    { return static_cast<const FrameHistory*>(data)->samples()[static_cast<size_t>(i)].energy; };
    float most = 0;
    for (const FrameSample& sample : history.samples())
        most = std::max(most, sample.energy);
    const auto count = static_cast<int>(history.samples().size());
    ImGui::PlotLines("##energy", energy, const_cast<FrameHistory*>(&history), count, 0, nullptr, 0, 1.1f * most,
                     {ImGui::GetContentRegionAvail().x, 50});
    ImGui::Text("kinetic energy: %.3g J, at most %.3g", static_cast<double>(history.samples().back().energy),
                static_cast<double>(most));
}

void show_boxes(DebugOptions& debug)
{
    constexpr uint32_t k_first_level = 4;
    constexpr int k_deepest = 16;
    bool boxes = debug.boxes.has_value();
    if (ImGui::Checkbox("hierarchy of mesh colliders", &boxes))
        debug.boxes = boxes ? std::optional(k_first_level) : std::nullopt;
    if (!debug.boxes)
        return;
    auto level = static_cast<int>(*debug.boxes);
    if (ImGui::SliderInt("level", &level, 0, k_deepest, "%d", ImGuiSliderFlags_AlwaysClamp))
        debug.boxes = static_cast<uint32_t>(level);
}

void show_shader_errors(const WatchedShaders& shaders)
{
    const std::string errors = shaders.errors();
    if (errors.empty())
        return;
    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(255, 120, 100, 255));
    ImGui::TextWrapped("shaders: %s", errors.c_str());
    ImGui::PopStyleColor();
}

} // namespace

void show_run(PanelContents& panel)
{
    Controls& controls = panel.controls;
    if (ImGui::Button(controls.paused ? "Continue" : "Pause"))
        controls.paused = !controls.paused;
    ImGui::SameLine();
    if (ImGui::Button("Step") && controls.paused)
        controls.step();
    ImGui::SameLine();
    if (ImGui::Button("Restart"))
        controls.restart();
    ImGui::SameLine();
    if (ImGui::Button("Show all"))
        controls.show_all();
    ImGui::SameLine();
    if (ImGui::Button("Help"))
        controls.show_help = !controls.show_help;
    ImGui::SliderFloat("speed of time", &controls.speed, k_slowest, 1, "%.3f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    ImGui::Text("frame %llu, %.2f s", static_cast<unsigned long long>(panel.app.frame_count()), panel.app.time());
    if (ImGui::BeginCombo("scene", panel.scene.file.name.c_str()))
    {
        for (const std::string& name : panel.scene_names)
            if (ImGui::Selectable(name.c_str(), name == panel.scene.file.name))
                controls.open_scene(name);
        ImGui::EndCombo();
    }
    if (ImGui::Button("Save scene"))
        controls.save_scene();
    ImGui::SameLine();
    if (ImGui::Button("Save picture"))
        controls.save_picture();
    if (!controls.message().empty())
        ImGui::TextWrapped("%s", controls.message().c_str());
    show_shader_errors(panel.shaders);
}

void show_times(const PanelContents& panel)
{
    if (!ImGui::CollapsingHeader("Times and energy", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    ImGui::Text("frame: %.1f ms, recorded in %.2f ms", 1000 * static_cast<double>(panel.frame_seconds),
                panel.app.record_milliseconds());
    show_plots(panel.history);
}

void show_views(PanelContents& panel)
{
    if (!ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen))
        return;
    voile::engine::ViewModes& modes = panel.app.renderer().modes;
    if (panel.app.device().draws_wires())
        ImGui::Checkbox("wireframe", &modes.wires);
    bool strain = modes.full_strain > 0;
    if (ImGui::Checkbox("strain", &strain))
        modes.full_strain = strain ? 0.05f : 0.f;
    if (strain)
        ImGui::SliderFloat("red at l/L - 1 =", &modes.full_strain, 0.001f, 1, "%.3f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (panel.scene.debug == nullptr)
        return;
    DebugOptions debug = panel.scene.debug->options();
    ImGui::Checkbox("contacts", &debug.contacts);
    ImGui::Checkbox("normals", &debug.normals);
    ImGui::Checkbox("intersections", &debug.intersections);
    show_boxes(debug);
    panel.scene.debug->set_options(debug);
    panel.scene.options.debug = debug; // a restart keeps it
}

void show_help(bool& open)
{
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x - 8, 8}, ImGuiCond_Appearing, {1, 0}); // beside the panel
    if (ImGui::Begin("Keys and mouse", &open, ImGuiWindowFlags_AlwaysAutoResize) && ImGui::BeginTable("keys", 2))
    {
        for (const ControlHelp& line : control_help())
        {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(line.action);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

} // namespace viewer
