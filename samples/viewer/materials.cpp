// Presets, and what a scene file changes of them.
#include "samples/viewer/materials.hpp"

#include "samples/viewer/text.hpp"

#include "voile/fabrics.hpp"
#include "voile/material_parameters.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

// Writes a value that the scene gives, if the material has a parameter of that name.
template <typename M, size_t N>
void apply(const MaterialValue& value, const std::array<voile::MaterialParameter<M>, N>& parameters, M& material)
{
    const voile::MaterialParameter<M>* parameter = voile::find_parameter(parameters, value.name);
    if (parameter == nullptr)
        return;
    for (size_t i = 0; i < parameter->components().size(); ++i)
        parameter->components()[i].member.ref(material) = value.numbers[value.numbers.size() > 1 ? i : 0];
}

// A preset's value must not put one that the scene gives out of order.
template <typename M, size_t N>
void keep_order(const MaterialEntry& entry, const std::array<voile::MaterialParameter<M>, N>& parameters, M& material)
{
    for (const voile::MaterialParameter<M>& parameter : parameters)
    {
        if (parameter.rule.least_name == nullptr)
            continue;
        float& value = parameter.components()[0].member.ref(material);
        float& least = parameter.rule.least.ref(material);
        if (entry.find(parameter.name) == nullptr)
            value = std::max(value, least);
        if (entry.find(parameter.rule.least_name) == nullptr)
            least = std::min(value, least);
    }
}

bool is_of_fabric(const MaterialValue& value)
{
    return voile::find_parameter(voile::k_fabric_parameters, value.name) != nullptr;
}

bool is_of_material(const MaterialValue& value)
{
    return voile::find_parameter(voile::k_material_parameters, value.name) != nullptr;
}

// Of a fabric's value and a raw one that would replace it without a word: what both of them give; nothing if there are
// no such two.
std::string given_twice(const MaterialEntry& entry)
{
    if (entry.find("vertex_mass") && entry.find("areal_density"))
        return "vertex_mass and areal_density both give the mass";
    const bool bend_springs = entry.preset != "reference" && entry.find("bending_stiffness") &&
                              entry.bending_model != voile::BendingModel::isometric;
    if (entry.find("spring_stiffness") &&
        (entry.find("stretch_stiffness") || entry.find("shear_stiffness") || bend_springs))
        return "spring_stiffness gives the stiffness of all springs, as stretch_stiffness, shear_stiffness and "
               "bending_stiffness do";
    if (entry.find("spring_damping") && entry.find("damping_ratio"))
        return "spring_damping and damping_ratio both give the damping of springs";
    return {};
}

template <typename M, size_t N>
std::vector<MaterialValue> values_of(const M& material, const std::array<voile::MaterialParameter<M>, N>& parameters)
{
    std::vector<MaterialValue> values;
    for (const voile::MaterialParameter<M>& parameter : parameters)
    {
        MaterialValue& value = values.emplace_back(MaterialValue{parameter.name, {}});
        for (const auto& component : parameter.components())
            value.numbers.push_back(component.member.get(material));
    }
    return values;
}

// The names of the parameters that Material has alone, for messages: "vertex_mass, ... and linear_drag".
std::string raw_names()
{
    std::string names;
    for (const auto& parameter : voile::k_own_material_parameters)
        if (voile::find_parameter(voile::k_fabric_parameters, parameter.name) == nullptr)
            names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    return names.replace(names.rfind(","), 1, " and");
}

} // namespace

voile::Result<voile::ClothMaterial> make_cloth_material(const SceneFile& scene, const MaterialEntry& entry,
                                                        const std::optional<glm::vec2>& spacing)
{
    const auto bad = [&](const std::string& reason) { return error_at(scene, entry.location, reason); };
    if (const std::string twice = given_twice(entry); !twice.empty())
        return bad(twice + "; leave one out");
    voile::ClothMaterial result;
    if (entry.preset == "reference")
    {
        if (entry.bending_model || !std::all_of(entry.values.begin(), entry.values.end(), is_of_material))
            return bad("the preset \"reference\" gives masses and springs outright; it takes " + raw_names() +
                       ", not a fabric's values");
        voile::Material material = voile::reference_material();
        for (const MaterialValue& value : entry.values)
            apply(value, voile::k_material_parameters, material);
        keep_order(entry, voile::k_material_parameters, material);
        result = material;
    }
    else
    {
        const std::string preset = entry.preset.value_or("cotton");
        std::optional<voile::Fabric> fabric = voile::find_fabric(preset);
        if (!fabric)
            return bad("unknown preset " + in_quotes(preset) +
                       "; there are silk, cotton, wool, denim, leather and reference");
        for (const MaterialValue& value : entry.values)
            apply(value, voile::k_fabric_parameters, *fabric);
        fabric->bending_model = entry.bending_model.value_or(fabric->bending_model);
        keep_order(entry, voile::k_fabric_parameters, *fabric);
        result = *fabric;
        if (!std::all_of(entry.values.begin(), entry.values.end(), is_of_fabric))
        {
            if (!spacing)
                return bad(raw_names() + " on a mesh need the preset \"reference\"");
            if (const auto valid = voile::validate(*fabric); !valid)
                return bad(valid.error().message);
            voile::Material material = voile::make_material(*fabric, spacing->x, spacing->y);
            for (const MaterialValue& value : entry.values)
                if (!is_of_fabric(value))
                    apply(value, voile::k_material_parameters, material);
            result = material;
        }
    }
    if (const auto valid = std::visit([](const auto& m) { return voile::validate(m); }, result); !valid)
        return bad(valid.error().message);
    return result;
}

MaterialEntry entry_of(const voile::ClothMaterial& material)
{
    MaterialEntry entry;
    if (const auto* fabric = std::get_if<voile::Fabric>(&material))
    {
        entry.values = values_of(*fabric, voile::k_fabric_parameters);
        entry.bending_model = fabric->bending_model;
        return entry;
    }
    entry.preset = "reference";
    entry.values = values_of(std::get<voile::Material>(material), voile::k_material_parameters);
    return entry;
}

} // namespace viewer
