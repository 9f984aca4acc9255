// Materials: from fabric properties to springs, and the checks of both.
#include "voile/material_parameters.hpp"

#include "model/range_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace voile
{

namespace
{

template <typename M>
Result<void> check_parameter(const std::string& what, const M& material, const MaterialParameter<M>& parameter)
{
    for (const ParameterComponent<M>& component : parameter.components())
    {
        const float value = component.member.get(material);
        const ParameterRule<M>& rule = parameter.rule;
        if (rule.or_zero && value == 0)
            continue;
        if (rule.least_name != nullptr && !(value >= rule.least.get(material)))
            return Error{what + ": " + parameter.name + " is " + text(value) + ", must be at least " + rule.least_name +
                         ", " + text(rule.least.get(material))};
        const std::string name =
            *component.name == '\0' ? parameter.name : parameter.name + (" (" + std::string(component.name) + ")");
        const std::string unit = *parameter.unit == '\0' ? "" : std::string(" ") + parameter.unit;
        if (auto valid = check(what, {name.c_str(), value, parameter.min, parameter.max, unit.c_str()}); !valid)
            return rule.or_zero ? Error{valid.error().message + ", or 0 for none"} : valid.error();
    }
    return {};
}

template <typename M, size_t N>
Result<void> check_parameters(const std::string& what, const M& material,
                              const std::array<MaterialParameter<M>, N>& parameters)
{
    for (const MaterialParameter<M>& parameter : parameters)
        if (auto valid = check_parameter(what, material, parameter); !valid)
            return valid;
    return {};
}

template <typename M, size_t N>
std::string list_parameters(const M& material, const std::array<MaterialParameter<M>, N>& parameters)
{
    std::string list;
    for (const MaterialParameter<M>& parameter : parameters)
    {
        list += (list.empty() ? "" : ", ") + std::string(parameter.name);
        for (const ParameterComponent<M>& component : parameter.components())
            list += " " + text(component.member.get(material));
        list += (*parameter.unit == '\0' ? "" : " ") + std::string(parameter.unit);
    }
    return list;
}

// What both have in common.
void copy_parameters(const Fabric& fabric, Material& material)
{
    for (size_t i = 0; i < k_common_parameters<Fabric>.size(); ++i)
        for (size_t c = 0; c < k_common_parameters<Fabric>[i].components().size(); ++c)
            k_common_parameters<Material>[i].components()[c].member.ref(material) =
                k_common_parameters<Fabric>[i].components()[c].member.get(fabric);
}

Spring damped_spring(float stiffness, float damping_ratio, float vertex_mass)
{
    return {stiffness, 2 * damping_ratio * std::sqrt(stiffness * vertex_mass / 2)};
}

// N/m: the shear stiffness from which on diagonals alone resist stretch along one axis more than the fabric does, whose
// stiffness there is `along`. `q`: the squared ratio of the cell's side along that axis to the other.
double most_shear(double along, double across, double q)
{
    const double ratio = along / across;
    return q * q > ratio ? along * q / (q * q - ratio) : std::numeric_limits<double>::infinity();
}

} // namespace

Material make_material(const Fabric& fabric, float spacing_along_row, float spacing_along_column)
{
    const double a = static_cast<double>(spacing_along_row);
    const double b = static_cast<double>(spacing_along_column);
    const double warp = static_cast<double>(fabric.stretch_stiffness[0]);
    const double weft = static_cast<double>(fabric.stretch_stiffness[1]);
    const double shear = std::min({static_cast<double>(fabric.shear_stiffness), most_shear(warp, weft, a * a / (b * b)),
                                   most_shear(weft, warp, b * b / (a * a))});
    const double held = 0.5 * (warp + std::sqrt(warp * warp + 4 * shear * shear * warp / weft));
    Material material;
    material.vertex_mass = static_cast<float>(static_cast<double>(fabric.areal_density) * a * b);
    material.border_scale = 0.5f;
    const auto spring = [&](double stiffness)
    { return damped_spring(static_cast<float>(std::max(stiffness, 0.0)), fabric.damping_ratio, material.vertex_mass); };
    const auto structural = [&](double all, double of_diagonals, double sides) {
        return spring(all - of_diagonals > 1e-9 * all ? (all - of_diagonals) * sides : 0);
    }; // of 0 rounding leaves a rest
    material.springs.structural_warp = structural(held, shear * a * a / (b * b), b / a);
    material.springs.structural_weft = structural(held * weft / warp, shear * b * b / (a * a), a / b);
    material.springs.shear = spring(shear * (a * a + b * b) / (2 * a * b));
    if (fabric.bending_model == BendingModel::springs)
        material.springs.bend_warp = material.springs.bend_weft =
            spring(static_cast<double>(fabric.bending_stiffness) / (a * b));
    else if (fabric.bending_stiffness > 0)
    {
        material.bending_stiffness = fabric.bending_stiffness;
        // The mode that alternates along rows and columns: 16 B (b / a^3 + a / b^3 + 2 / (a b)) / m.
        const double omega = 4 * (b / a + a / b) *
                             std::sqrt(static_cast<double>(fabric.bending_stiffness) /
                                       (a * b * static_cast<double>(material.vertex_mass)));
        material.bending_time = static_cast<float>(2 * static_cast<double>(fabric.damping_ratio) / omega);
    }
    copy_parameters(fabric, material);
    return material;
}

Material reference_material()
{
    constexpr Spring k_spring{400, 10};
    Material material;
    material.vertex_mass = 0.15f;
    material.springs = {k_spring, k_spring, k_spring, k_spring, k_spring, k_spring};
    material.thickness = 0.03f;
    material.static_friction = 0.4f;
    material.kinetic_friction = 0.4f;
    material.linear_drag = 0.1f;
    return material;
}

Result<void> validate(const Material& material)
{
    return check_parameters("material", material, k_material_parameters);
}

Result<void> validate(const Fabric& fabric)
{
    if (auto valid = check_parameters("fabric", fabric, k_fabric_parameters); !valid)
        return valid;
    return check_enumerator("fabric", "bending_model", static_cast<int>(fabric.bending_model),
                            {k_bending_models[0], k_bending_models[1]});
}

std::string to_string(const Material& material)
{
    return list_parameters(material, k_material_parameters);
}

std::string to_string(const Fabric& fabric)
{
    const bool isometric = fabric.bending_model == BendingModel::isometric;
    return list_parameters(fabric, k_fabric_parameters) + ", bending_model " + k_bending_models[isometric ? 1 : 0];
}

} // namespace voile
