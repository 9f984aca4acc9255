// The panel's sliders: materials, by the table of voile/material_parameters.hpp; wind and step, by that of
// step_parameters.hpp.
#include "samples/viewer/panel_contents.hpp"

#include "samples/viewer/looks.hpp"
#include "samples/viewer/materials.hpp"
#include "samples/viewer/step_parameters.hpp"

#include "voile/fabrics.hpp"
#include "voile/material_parameters.hpp"

#include <imgui.h>

#include <algorithm>

namespace viewer
{
namespace
{

constexpr uint32_t k_least_limit = 1; // of substeps
constexpr uint32_t k_most_limit = voile::k_most_substeps;
constexpr ImGuiSliderFlags k_log = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;

void show_tip(const char* meaning)
{
    if (!ImGui::IsItemHovered())
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360);
    ImGui::TextUnformatted(meaning);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

std::string format_of(const char* unit)
{
    return std::string("%.4g ") + unit;
}

// Wide ranges are logarithmic.
ImGuiSliderFlags flags_of(float min, float max)
{
    return max - min > 20 || (min > 0 && max > 100 * min) ? k_log : ImGuiSliderFlags_AlwaysClamp;
}

template <typename M>
bool show_parameter(M& material, const voile::MaterialParameter<M>& parameter)
{
    bool changed = false;
    const std::string format = format_of(parameter.unit);
    const float min = parameter.rule.or_zero ? 0 : parameter.min;
    for (const voile::ParameterComponent<M>& component : parameter.components())
    {
        const std::string label =
            parameter.components().size() > 1 ? std::string(parameter.name) + ": " + component.name : parameter.name;
        float& value = component.member.ref(material);
        changed |=
            ImGui::SliderFloat(label.c_str(), &value, min, parameter.max, format.c_str(), flags_of(min, parameter.max));
        show_tip(parameter.meaning);
        if (parameter.rule.or_zero && value < parameter.min)
            value = 0;
    }
    return changed;
}

// The one that was not moved follows: a parameter with a least value never lies below it.
template <typename M, size_t N>
void keep_order(const M& before, M& material, const std::array<voile::MaterialParameter<M>, N>& parameters)
{
    for (const voile::MaterialParameter<M>& parameter : parameters)
    {
        if (parameter.rule.least_name == nullptr)
            continue;
        float& value = parameter.components()[0].member.ref(material);
        float& least = parameter.rule.least.ref(material);
        if (value >= least)
            continue;
        if (least != parameter.rule.least.get(before))
            value = least;
        else
            least = value;
    }
}

template <typename M, size_t N>
bool show_parameters(M& material, const std::array<voile::MaterialParameter<M>, N>& parameters)
{
    const M before = material;
    bool changed = false;
    for (const voile::MaterialParameter<M>& parameter : parameters)
        changed |= show_parameter(material, parameter);
    keep_order(before, material, parameters);
    return changed;
}

bool show_material(voile::Material& material)
{
    return show_parameters(material, voile::k_material_parameters);
}

bool show_material(voile::Fabric& fabric)
{
    auto model = static_cast<int>(fabric.bending_model);
    bool changed = ImGui::Combo("bending_model", &model, voile::k_bending_models.data(),
                                static_cast<int>(voile::k_bending_models.size()));
    fabric.bending_model = static_cast<voile::BendingModel>(model);
    changed |= show_parameters(fabric, voile::k_fabric_parameters);
    return changed;
}

// A preset for the whole cloth. One with another kind of material needs a new start.
void show_presets(PanelContents& panel, size_t cloth)
{
    if (!ImGui::BeginCombo("fabric", "choose a preset"))
        return;
    voile::Solver& solver = panel.scene.stage.world->solver();
    const voile::ClothId id = panel.scene.stage.cloths[cloth].id;
    for (const char* name : k_presets)
    {
        if (!ImGui::Selectable(name))
            continue;
        panel.scene.file.cloths[cloth].material = {.preset = name, .values = {}, .bending_model = {}, .location = {}};
        const std::optional<voile::Fabric> fabric = voile::find_fabric(name);
        const bool live =
            fabric && std::holds_alternative<voile::Fabric>(solver.material(id)) && solver.set_material(id, *fabric);
        const StageCloth& drawn = panel.scene.stage.cloths[cloth];
        if (live)
            drawn.sheet->set_surface(cloth_surface(panel.scene.file.cloths[cloth], cloth, drawn.size));
        else
            panel.controls.restart();
    }
    ImGui::EndCombo();
}

} // namespace

void show_materials(PanelContents& panel)
{
    for (size_t i = 0; i < panel.scene.stage.cloths.size(); ++i)
    {
        const std::string header = "Material of " + panel.scene.stage.cloths[i].name;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::CollapsingHeader(header.c_str()))
        {
            show_presets(panel, i);
            voile::Solver& solver = panel.scene.stage.world->solver();
            const voile::ClothId id = panel.scene.stage.cloths[i].id;
            voile::ClothMaterial material = solver.material(id);
            if (std::visit([](auto& m) { return show_material(m); }, material))
            {
                if (const auto set = solver.set_material(id, material); set)
                {
                    MaterialEntry& entry = panel.scene.file.cloths[i].material;
                    const std::optional<std::string> preset = entry.preset; // which gives the cloth its look
                    entry = entry_of(material);
                    if (std::holds_alternative<voile::Fabric>(material))
                        entry.preset = preset;
                }
                else
                    panel.controls.say(set.error().message);
            }
        }
        ImGui::PopID();
    }
}

void show_step(PanelContents& panel)
{
    if (!ImGui::CollapsingHeader("Wind and step"))
        return;
    SceneFile& file = panel.scene.file;
    const SceneFile before = file;
    bool changed = false;
    for (const StepParameter& parameter : k_step_parameters)
    {
        const bool single = parameter.count == 1; // three are too narrow for a unit each
        const std::string label = single ? parameter.name : std::string(parameter.name) + ", " + parameter.unit;
        changed |= ImGui::SliderScalarN(label.c_str(), ImGuiDataType_Float, parameter.value(file),
                                        static_cast<int>(parameter.count), &parameter.min, &parameter.max,
                                        (single ? format_of(parameter.unit) : "%.3g").c_str(),
                                        flags_of(parameter.min, parameter.max));
        show_tip(parameter.meaning);
    }
    changed |= ImGui::SliderScalar("max_substeps", ImGuiDataType_U32, &file.step.max_substeps, &k_least_limit,
                                   &k_most_limit, "%u", k_log);
    show_tip("the most substeps that a cloth takes, if their number is auto");
    auto substeps = static_cast<int>(file.step.substeps.value_or(0));
    if (ImGui::SliderInt("substeps", &substeps, 0, static_cast<int>(k_most_substeps), substeps == 0 ? "auto" : "%d",
                         ImGuiSliderFlags_AlwaysClamp))
    {
        changed = true;
        file.step.substeps = substeps > 0 ? std::optional(static_cast<uint32_t>(substeps)) : std::nullopt;
    }
    if (!changed)
        return;
    voile::Step step = panel.scene.stage.world->step;
    apply_step(file, step);
    if (const auto valid = voile::validate(step); valid)
        panel.scene.stage.world->step = step;
    else
    {
        file = before;
        panel.controls.say(valid.error().message);
    }
}

} // namespace viewer
