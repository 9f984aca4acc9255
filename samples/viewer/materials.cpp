// Presets, and what a scene file changes of them.
#include "samples/viewer/materials.hpp"

#include "samples/viewer/text.hpp"

#include "voile/fabrics.hpp"

#include <algorithm>

namespace viewer
{
namespace
{

void override_with(const std::optional<float>& value, float& target)
{
    if (value)
        target = *value;
}

void apply(const MaterialEntry& entry, voile::Fabric& fabric)
{
    override_with(entry.areal_density, fabric.areal_density);
    if (entry.stretch_stiffness)
        fabric.stretch_stiffness = {entry.stretch_stiffness->x, entry.stretch_stiffness->y};
    override_with(entry.shear_stiffness, fabric.shear_stiffness);
    override_with(entry.bending_stiffness, fabric.bending_stiffness);
    override_with(entry.damping_ratio, fabric.damping_ratio);
    if (entry.bending_model)
        fabric.bending_model = *entry.bending_model == BendingModel::isometric ? voile::BendingModel::isometric
                                                                               : voile::BendingModel::springs;
}

// What fabrics and materials have alike.
template <typename M>
void apply_surface(const MaterialEntry& entry, M& material)
{
    override_with(entry.thickness, material.thickness);
    override_with(entry.kinetic_friction, material.kinetic_friction);
    override_with(entry.static_friction, material.static_friction);
    // One of the two alone must not put them out of order.
    if (!entry.static_friction)
        material.static_friction = std::max(material.static_friction, material.kinetic_friction);
    if (!entry.kinetic_friction)
        material.kinetic_friction = std::min(material.static_friction, material.kinetic_friction);
    override_with(entry.air_drag_normal, material.air_drag_normal);
    override_with(entry.air_drag_tangential, material.air_drag_tangential);
    override_with(entry.strain_limit, material.strain_limit);
}

void apply_raw(const MaterialEntry& entry, voile::Material& material)
{
    override_with(entry.vertex_mass, material.vertex_mass);
    override_with(entry.linear_drag, material.linear_drag);
    voile::SpringSet& s = material.springs;
    for (voile::Spring* spring :
         {&s.structural_warp, &s.structural_weft, &s.shear, &s.bend_warp, &s.bend_weft, &s.diagonal_bend})
    {
        override_with(entry.spring_stiffness, spring->stiffness);
        override_with(entry.spring_damping, spring->damping);
    }
}

bool has_fabric_values(const MaterialEntry& entry)
{
    return entry.areal_density || entry.stretch_stiffness || entry.shear_stiffness || entry.bending_stiffness ||
           entry.damping_ratio || entry.bending_model;
}

bool has_raw_values(const MaterialEntry& entry)
{
    return entry.vertex_mass || entry.spring_stiffness || entry.spring_damping || entry.linear_drag;
}

// Of a fabric's value and a raw one that would replace it without a word: what both of them give; nothing if there are
// no such two.
std::string given_twice(const MaterialEntry& entry)
{
    if (entry.vertex_mass && entry.areal_density)
        return "vertex_mass and areal_density both give the mass";
    const bool bend_springs = entry.bending_stiffness && entry.bending_model != BendingModel::isometric;
    if (entry.spring_stiffness && (entry.stretch_stiffness || entry.shear_stiffness || bend_springs))
        return "spring_stiffness gives the stiffness of all springs, as stretch_stiffness, shear_stiffness and "
               "bending_stiffness do";
    if (entry.spring_damping && entry.damping_ratio)
        return "spring_damping and damping_ratio both give the damping of springs";
    return {};
}

} // namespace

voile::gpu::Result<voile::ClothMaterial> make_cloth_material(const SceneFile& scene, const MaterialEntry& entry,
                                                             const std::optional<glm::vec2>& spacing)
{
    const auto bad = [&](const std::string& reason) { return error_at(scene, entry.place, reason); };
    if (const std::string twice = given_twice(entry); !twice.empty())
        return bad(twice + "; leave one out");
    voile::ClothMaterial result;
    if (entry.preset == "reference")
    {
        if (has_fabric_values(entry))
            return bad("the preset \"reference\" gives masses and springs outright; it takes vertex_mass, "
                       "spring_stiffness and spring_damping, not a fabric's values");
        voile::Material material = voile::reference_material();
        apply_raw(entry, material);
        result = material;
    }
    else
    {
        const std::string preset = entry.preset.value_or("cotton");
        std::optional<voile::Fabric> fabric = voile::find_fabric(preset);
        if (!fabric)
            return bad("unknown preset " + in_quotes(preset) +
                       "; there are silk, cotton, wool, denim, leather and reference");
        apply(entry, *fabric);
        if (const auto valid = voile::validate(*fabric); !valid)
            return bad(valid.error().message);
        result = *fabric;
        if (has_raw_values(entry))
        {
            if (!spacing)
                return bad("vertex_mass, spring_stiffness, spring_damping and linear_drag on a mesh need the preset "
                           "\"reference\"");
            voile::Material material = voile::make_material(*fabric, spacing->x, spacing->y);
            apply_raw(entry, material);
            result = material;
        }
    }
    std::visit([&](auto& m) { apply_surface(entry, m); }, result);
    if (const auto valid = std::visit([](const auto& m) { return voile::validate(m); }, result); !valid)
        return bad(valid.error().message);
    return result;
}

} // namespace viewer
