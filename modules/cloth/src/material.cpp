// Materials: from fabric properties to springs, and the checks of both.
#include "cloth/material.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace cloth
{

namespace
{

std::string text(float value)
{
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%g", static_cast<double>(value));
    return buffer;
}

struct Range
{
    const char* name;
    float value;
    float min;
    bool min_excluded;
    const char* unit;
};

Result<void> check(const char* what, const Range& range)
{
    const bool above = range.min_excluded ? range.value > range.min : range.value >= range.min;
    if (std::isfinite(range.value) && above)
        return {};
    return Error{std::string(what) + ": " + range.name + " is " + text(range.value) + range.unit +
                 ", must be finite and " + (range.min_excluded ? "> " : ">= ") + text(range.min)};
}

Result<void> check_friction(const char* what, float static_friction, float kinetic_friction)
{
    if (auto result = check(what, {"kinetic_friction", kinetic_friction, 0, false, ""}); !result)
        return result;
    if (!std::isfinite(static_friction) || static_friction < kinetic_friction)
        return Error{std::string(what) + ": static_friction is " + text(static_friction) +
                     ", must be finite and at least kinetic_friction, " + text(kinetic_friction)};
    return {};
}

Spring damped_spring(float stiffness, float damping_ratio, float vertex_mass)
{
    return {stiffness, 2 * damping_ratio * std::sqrt(stiffness * vertex_mass / 2)};
}

} // namespace

Material make_material(const Fabric& fabric, float spacing_along_row, float spacing_along_column)
{
    const double a = static_cast<double>(spacing_along_row);
    const double b = static_cast<double>(spacing_along_column);
    const double warp = static_cast<double>(fabric.stretch_stiffness[0]);
    const double weft = static_cast<double>(fabric.stretch_stiffness[1]);
    const double shear = static_cast<double>(fabric.shear_stiffness);
    const double held = 0.5 * (warp + std::sqrt(warp * warp + 4 * shear * shear * warp / weft));
    Material material;
    material.vertex_mass = static_cast<float>(static_cast<double>(fabric.areal_density) * a * b);
    material.border_share = 0.5f;
    const auto spring = [&](double stiffness)
    { return damped_spring(static_cast<float>(std::max(stiffness, 0.0)), fabric.damping_ratio, material.vertex_mass); };
    material.springs.structural_warp = spring((held - shear * a * a / (b * b)) * b / a);
    material.springs.structural_weft = spring((held * weft / warp - shear * b * b / (a * a)) * a / b);
    material.springs.shear = spring(shear * (a * a + b * b) / (2 * a * b));
    material.springs.bend_warp = spring(static_cast<double>(fabric.bending_stiffness) / (a * b));
    material.springs.bend_weft = material.springs.bend_warp;
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
    const Range ranges[] = {
        {"vertex_mass", material.vertex_mass, 0, true, " kg"},
        {"thickness", material.thickness, 0, true, " m"},
        {"linear_drag", material.linear_drag, 0, false, " N s/m"},
        {"air_drag_normal", material.air_drag_normal, 0, false, ""},
        {"air_drag_tangential", material.air_drag_tangential, 0, false, ""},
        {"structural_warp stiffness", s.structural_warp.stiffness, 0, false, " N/m"},
        {"structural_warp damping", s.structural_warp.damping, 0, false, " N s/m"},
        {"structural_weft stiffness", s.structural_weft.stiffness, 0, false, " N/m"},
        {"structural_weft damping", s.structural_weft.damping, 0, false, " N s/m"},
        {"shear stiffness", s.shear.stiffness, 0, false, " N/m"},
        {"shear damping", s.shear.damping, 0, false, " N s/m"},
        {"bend_warp stiffness", s.bend_warp.stiffness, 0, false, " N/m"},
        {"bend_warp damping", s.bend_warp.damping, 0, false, " N s/m"},
        {"bend_weft stiffness", s.bend_weft.stiffness, 0, false, " N/m"},
        {"bend_weft damping", s.bend_weft.damping, 0, false, " N s/m"},
        {"diagonal_bend stiffness", s.diagonal_bend.stiffness, 0, false, " N/m"},
        {"diagonal_bend damping", s.diagonal_bend.damping, 0, false, " N s/m"},
    };
    for (const Range& range : ranges)
        if (auto result = check("material", range); !result)
            return result;
    if (!(material.border_share > 0) || material.border_share > 1)
        return Error{"material: border_share is " + text(material.border_share) + ", must be > 0 and at most 1"};
    return check_friction("material", material.static_friction, material.kinetic_friction);
}

Result<void> validate(const Fabric& fabric)
{
    const Range ranges[] = {
        {"areal_density", fabric.areal_density, 0, true, " kg/m^2"},
        {"stretch_stiffness (warp)", fabric.stretch_stiffness[0], 0, true, " N/m"},
        {"stretch_stiffness (weft)", fabric.stretch_stiffness[1], 0, true, " N/m"},
        {"shear_stiffness", fabric.shear_stiffness, 0, false, " N/m"},
        {"bending_stiffness", fabric.bending_stiffness, 0, false, " N m"},
        {"damping_ratio", fabric.damping_ratio, 0, false, ""},
        {"thickness", fabric.thickness, 0, true, " m"},
        {"air_drag_normal", fabric.air_drag_normal, 0, false, ""},
        {"air_drag_tangential", fabric.air_drag_tangential, 0, false, ""},
    };
    for (const Range& range : ranges)
        if (auto result = check("fabric", range); !result)
            return result;
    if (fabric.damping_ratio > 1)
        return Error{"fabric: damping_ratio is " + text(fabric.damping_ratio) + ", must be at most 1"};
    return check_friction("fabric", fabric.static_friction, fabric.kinetic_friction);
}

} // namespace cloth
