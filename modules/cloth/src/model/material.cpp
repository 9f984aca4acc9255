// Materials: from fabric properties to springs, and the checks of both.
#include "voile/material.hpp"

#include "model/range_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace voile
{

namespace
{

constexpr float k_least_thickness = 1e-5f; // m
constexpr float k_most_spring = 1e7f;      // N/m
constexpr float k_most_damping = 1e6f;     // N s/m
constexpr float k_most_bending = 1e3f;     // N m
constexpr float k_least_strain = 1e-3f;
constexpr float k_most_strain = 10;

Result<void> check_strain_limit(const std::string& what, float limit)
{
    if (limit == 0)
        return {};
    if (auto result = check(what, {"strain_limit", limit, k_least_strain, k_most_strain, ""}); !result)
        return Error{result.error().message + ", or 0 for none"};
    return {};
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
    material.border_share = 0.5f;
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
    material.strain_limit = fabric.strain_limit;
    material.thickness = fabric.thickness;
    material.static_friction = fabric.static_friction;
    material.kinetic_friction = fabric.kinetic_friction;
    material.air_drag_normal = fabric.air_drag_normal;
    material.air_drag_tangential = fabric.air_drag_tangential;
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
    const SpringSet& s = material.springs;
    const struct
    {
        const char* stiffness;
        const char* damping;
        const Spring& spring;
    } springs[] = {
        {"structural_warp stiffness", "structural_warp damping", s.structural_warp},
        {"structural_weft stiffness", "structural_weft damping", s.structural_weft},
        {"shear stiffness", "shear damping", s.shear},
        {"bend_warp stiffness", "bend_warp damping", s.bend_warp},
        {"bend_weft stiffness", "bend_weft damping", s.bend_weft},
        {"diagonal_bend stiffness", "diagonal_bend damping", s.diagonal_bend},
    };
    for (const auto& [stiffness, damping, spring] : springs)
    {
        if (auto result = check("material", {stiffness, spring.stiffness, 0, k_most_spring, " N/m"}); !result)
            return result;
        if (auto result = check("material", {damping, spring.damping, 0, k_most_damping, " N s/m"}); !result)
            return result;
    }
    const Range ranges[] = {
        {"vertex_mass", material.vertex_mass, 1e-9f, 1e6f, " kg"},
        {"border_share", material.border_share, 0.1f, 1, ""},
        {"bending_stiffness", material.bending_stiffness, 0, k_most_bending, " N m"},
        {"bending_time", material.bending_time, 0, 1, " s"},
        {"thickness", material.thickness, k_least_thickness, 10, " m"},
        {"linear_drag", material.linear_drag, 0, 1e6f, " N s/m"},
        {"air_drag_normal", material.air_drag_normal, 0, 100, ""},
        {"air_drag_tangential", material.air_drag_tangential, 0, 100, ""},
    };
    for (const Range& range : ranges)
        if (auto result = check("material", range); !result)
            return result;
    if (auto result = check_strain_limit("material", material.strain_limit); !result)
        return result;
    return check_friction("material", material.static_friction, material.kinetic_friction);
}

Result<void> validate(const Fabric& fabric)
{
    const Range ranges[] = {
        {"areal_density", fabric.areal_density, 1e-3f, 1e3f, " kg/m^2"},
        {"stretch_stiffness (warp)", fabric.stretch_stiffness[0], 1e-2f, k_most_spring, " N/m"},
        {"stretch_stiffness (weft)", fabric.stretch_stiffness[1], 1e-2f, k_most_spring, " N/m"},
        {"shear_stiffness", fabric.shear_stiffness, 0, k_most_spring, " N/m"},
        {"bending_stiffness", fabric.bending_stiffness, 0, k_most_bending, " N m"},
        {"damping_ratio", fabric.damping_ratio, 0, 1, ""},
        {"thickness", fabric.thickness, k_least_thickness, 10, " m"},
        {"air_drag_normal", fabric.air_drag_normal, 0, 100, ""},
        {"air_drag_tangential", fabric.air_drag_tangential, 0, 100, ""},
    };
    for (const Range& range : ranges)
        if (auto result = check("fabric", range); !result)
            return result;
    if (auto result = check_enumerator("fabric", "bending_model", static_cast<int>(fabric.bending_model),
                                       {"springs", "isometric"});
        !result)
        return result;
    if (auto result = check_strain_limit("fabric", fabric.strain_limit); !result)
        return result;
    return check_friction("fabric", fabric.static_friction, fabric.kinetic_friction);
}

} // namespace voile
