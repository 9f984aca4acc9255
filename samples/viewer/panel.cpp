// Panel: Dear ImGui between the engine's input and its overlay.
#include "samples/viewer/panel.hpp"

#include "samples/viewer/panel_contents.hpp"

#include "voile/engine/render/overlay.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>

namespace viewer
{
namespace
{

using voile::engine::Input;
using voile::engine::Key;
using voile::engine::OverlayVertex;

static_assert(sizeof(ImDrawVert) == sizeof(OverlayVertex) &&
              offsetof(ImDrawVert, uv) == offsetof(OverlayVertex, coordinate) &&
              offsetof(ImDrawVert, col) == offsetof(OverlayVertex, color));
static_assert(sizeof(ImDrawIdx) == sizeof(uint16_t));

// The keys that edit a number.
constexpr std::array<std::pair<int, Key>, 11> k_keys{{{ImGuiKey_Tab, Key::tab},
                                                      {ImGuiKey_LeftArrow, Key::left},
                                                      {ImGuiKey_RightArrow, Key::right},
                                                      {ImGuiKey_UpArrow, Key::up},
                                                      {ImGuiKey_DownArrow, Key::down},
                                                      {ImGuiKey_Home, Key::home},
                                                      {ImGuiKey_End, Key::end},
                                                      {ImGuiKey_Delete, Key::del},
                                                      {ImGuiKey_Backspace, Key::backspace},
                                                      {ImGuiKey_Enter, Key::enter},
                                                      {ImGuiKey_A, Key::a}}};

void feed_keys(ImGuiIO& io, const Input& input)
{
    io.KeyCtrl = input.control;
    io.KeyShift = input.shift;
    io.KeyAlt = input.alt;
#if IMGUI_VERSION_NUM >= 18700
    io.AddKeyEvent(ImGuiMod_Ctrl, input.control);
    io.AddKeyEvent(ImGuiMod_Shift, input.shift);
#endif
    for (const auto& [name, key] : k_keys)
    {
        // A key that went down and up since the last frame is down for one frame.
        const bool down =
            input.is_held(key) || std::ranges::find(input.keys, key, &voile::engine::KeyPress::key) != input.keys.end();
#if IMGUI_VERSION_NUM >= 18700
        io.AddKeyEvent(static_cast<ImGuiKey>(name), down);
#else
        io.KeyMap[name] = static_cast<int>(key);
        io.KeysDown[static_cast<int>(key)] = down;
#endif
    }
    for (const char32_t character : input.text)
        io.AddInputCharacter(static_cast<unsigned int>(character));
}

void feed_mouse(ImGuiIO& io, const Input& input)
{
    io.MousePos = {input.cursor.x * io.DisplaySize.x, input.cursor.y * io.DisplaySize.y};
    io.MouseDown[0] = input.left.held || input.left.pressed;
    io.MouseDown[1] = input.right.held || input.right.pressed;
    io.MouseDown[2] = input.middle.held || input.middle.pressed;
    io.MouseWheel += input.wheel;
}

// What the panel uses is not for the scene. Releases are: they end what began there.
void take_used(const ImGuiIO& io, Input& input)
{
    if (io.WantCaptureMouse)
    {
        for (voile::engine::MouseButton* button : {&input.left, &input.right, &input.middle})
        {
            button->held = button->pressed = false;
            button->dragged = {};
        }
        input.wheel = 0;
    }
    if (io.WantTextInput)
    {
        input.keys.clear();
        input.held.reset();
    }
}

VkRect2D scissor(const ImVec4& clip)
{
    const auto left = static_cast<int32_t>(clip.x);
    const auto top = static_cast<int32_t>(clip.y);
    return {{left, top},
            {static_cast<uint32_t>(std::max(static_cast<int32_t>(clip.z) - left, 0)),
             static_cast<uint32_t>(std::max(static_cast<int32_t>(clip.w) - top, 0))}};
}

void convert(const ImDrawData& data, voile::engine::OverlayTriangles& triangles)
{
    triangles.vertices.clear();
    triangles.indices.clear();
    triangles.parts.clear();
    for (int i = 0; i < data.CmdListsCount; ++i)
    {
        const ImDrawList& list = *data.CmdLists[i];
        const size_t first_vertex = triangles.vertices.size();
        const auto first_index = static_cast<uint32_t>(triangles.indices.size());
        triangles.vertices.resize(first_vertex + static_cast<size_t>(list.VtxBuffer.Size));
        std::memcpy(triangles.vertices.data() + first_vertex, list.VtxBuffer.Data,
                    static_cast<size_t>(list.VtxBuffer.Size) * sizeof(ImDrawVert));
        triangles.indices.insert(triangles.indices.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
        for (const ImDrawCmd& command : list.CmdBuffer)
            triangles.parts.push_back({scissor(command.ClipRect), first_index + command.IdxOffset, command.ElemCount,
                                       static_cast<int32_t>(first_vertex + command.VtxOffset)});
    }
}

// The glyphs.
std::unique_ptr<voile::engine::Overlay> create_overlay(voile::engine::App& app)
{
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    const voile::engine::Coverage coverage{
        std::as_bytes(std::span(pixels, static_cast<size_t>(width) * static_cast<size_t>(height))),
        {static_cast<uint32_t>(width), static_cast<uint32_t>(height)}};
    return std::make_unique<voile::engine::Overlay>(app.device(), app.slots(), app.renderer().color().format(),
                                                    coverage);
}

} // namespace

struct Panel::State
{
    PanelContents contents;
    ImGuiContext* context = nullptr; // null without a window
    std::unique_ptr<voile::engine::Overlay> overlay{};
    voile::engine::OverlayTriangles triangles{};
};

Panel::Panel(voile::engine::App& app, LoadedScene& scene, Controls& controls, const WatchedShaders& shaders)
    : state_(new State{.contents = {.app = app, .scene = scene, .controls = controls, .shaders = shaders}})
{
    if (!app.has_window())
        return;
    IMGUI_CHECKVERSION();
    state_->context = ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // the viewer leaves no files behind
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.93f;
    state_->overlay = create_overlay(app);
    state_->contents.scene_names = scene_names();
}

Panel::~Panel()
{
    if (state_->context != nullptr)
        ImGui::DestroyContext(state_->context);
}

void Panel::update(Input& input, float seconds)
{
    if (state_->context == nullptr)
        return;
    PanelContents& contents = state_->contents;
    Controls& controls = contents.controls;
    contents.frame_seconds += 0.1f * (seconds - contents.frame_seconds);
    const VkExtent2D extent = contents.app.renderer().extent();
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
    io.DeltaTime = std::max(seconds, 1e-4f);
    feed_mouse(io, input);
    feed_keys(io, input);
    ImGui::NewFrame();
    if (controls.show_panel)
    {
        ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
        const float height = std::max(io.DisplaySize.y - 16, 100.f); // as the window is resized, too
        ImGui::SetNextWindowSize({350, height}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints({200, height}, {io.DisplaySize.x, height});
        if (ImGui::Begin("Voile", &controls.show_panel))
        {
            ImGui::PushItemWidth(150);
            show_run(contents);
            show_times(contents);
            show_views(contents);
            show_materials(contents);
            show_step(contents);
            ImGui::PopItemWidth();
        }
        ImGui::End();
    }
    if (controls.show_help)
        show_help(controls.show_help);
    ImGui::Render();
    convert(*ImGui::GetDrawData(), state_->triangles);
    take_used(io, input);
}

void Panel::record(VkCommandBuffer cmd, const voile::engine::FrameInfo& frame)
{
    if (state_->overlay)
        state_->overlay->record(cmd, state_->contents.app.renderer().color(), frame.slot, state_->triangles);
}

void Panel::completed(const voile::engine::FrameInfo& frame)
{
    if (state_->context == nullptr || !frame.simulates || frame.timestamps == nullptr)
        return;
    const voile::Statistics statistics = state_->contents.scene.stage.world->solver().statistics(frame.slot);
    state_->contents.history.add(frame.timestamps->read(frame.slot), statistics.kinetic_energy);
}

} // namespace viewer
