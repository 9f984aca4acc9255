// The material of a cloth in a scene file, by the table in voile/material_parameters.hpp.
#include "samples/viewer/scene_parse.hpp"

#include "voile/material_parameters.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

void parse_preset(SceneReader& reader, const Field& field, MaterialEntry& material)
{
    if (reader.read_word(field, "a material", k_presets))
        material.preset = field.node->text;
}

template <typename M>
void parse_value(SceneReader& reader, const Field& field, const voile::MaterialParameter<M>& parameter,
                 MaterialEntry& material)
{
    if (!field || reader.failed())
        return;
    Range range = between(parameter.min, parameter.max);
    range.or_zero = parameter.rule.or_zero;
    const size_t components = parameter.components().size();
    MaterialValue value{parameter.name, {}};
    if (components > 1 && field.node->kind == JsonNode::Kind::array)
    {
        if (!reader.array(field, components))
            return;
        value.numbers.resize(components);
        for (size_t i = 0; i < components; ++i)
            reader.read(SceneReader::item(field, i), range, value.numbers[i]);
    }
    else
        reader.read(field, range, value.numbers.emplace_back());
    material.values.push_back(std::move(value));
}

// Of a parameter that must not be below another: both are written and it is.
template <typename M>
void check_order(SceneReader& reader, const Field& field, const voile::MaterialParameter<M>& parameter,
                 const MaterialEntry& material)
{
    if (parameter.rule.least_name == nullptr || reader.failed())
        return;
    const MaterialValue* value = material.find(parameter.name);
    const MaterialValue* least = material.find(parameter.rule.least_name);
    if (value != nullptr && least != nullptr && least->numbers[0] > value->numbers[0])
        reader.fail(SceneReader::child(field, parameter.rule.least_name), "is " + number_text(least->numbers[0]) +
                                                                              ", above " + parameter.name + ", " +
                                                                              number_text(value->numbers[0]));
}

// Calls `visit` for each parameter, once for those that both kinds of material have.
template <typename Visit>
void for_each_parameter(const Visit& visit)
{
    for (const auto& parameter : voile::k_fabric_parameters)
        visit(parameter);
    for (const auto& parameter : voile::k_material_parameters)
        if (voile::find_parameter(voile::k_fabric_parameters, parameter.name) == nullptr)
            visit(parameter);
}

} // namespace

const MaterialValue* MaterialEntry::find(std::string_view name) const
{
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const MaterialValue& value) { return value.name == name; });
    return found == values.end() ? nullptr : &*found;
}

MaterialEntry parse_material(SceneReader& reader, const Field& field)
{
    MaterialEntry material;
    material.location = location_of(field);
    if (!field || reader.failed())
        return material;
    if (field.node->kind == JsonNode::Kind::string)
    {
        parse_preset(reader, field, material);
        return material;
    }
    if (field.node->kind != JsonNode::Kind::object)
    {
        reader.fail(field, std::string("is ") + describe(field.node->kind) + "; expected a preset's name or an object");
        return material;
    }
    std::vector<std::string> keys{"preset", "bending_model"};
    for_each_parameter([&](const auto& parameter) { keys.emplace_back(parameter.name); });
    if (!reader.object(field, keys))
        return material;
    parse_preset(reader, SceneReader::child(field, "preset"), material);
    for_each_parameter([&](const auto& parameter)
                       { parse_value(reader, SceneReader::child(field, parameter.name), parameter, material); });
    const Field model = SceneReader::child(field, "bending_model");
    if (const auto word = reader.read_word(model, "a bending model", voile::k_bending_models))
        material.bending_model = static_cast<voile::BendingModel>(*word);
    for_each_parameter([&](const auto& parameter) { check_order(reader, field, parameter, material); });
    return material;
}

} // namespace viewer
