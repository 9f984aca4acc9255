// The parameters of materials, in one table: name, member, unit, range and meaning. The default is the member's, in
// Fabric{} or Material{}. Validation, the viewer's scene files, the tables of docs/scenes.md and to_string all read
// this table. A new parameter is a member of Fabric or Material and one line here.
//
//   for (const auto& parameter : voile::k_fabric_parameters)
//       for (const auto& component : parameter.components())
//           slider(parameter.name, component.member.ref(fabric), parameter.min, parameter.max);
#pragma once

#include "voile/material.hpp"
#include "voile/parameter.hpp"
#include "voile/ranges.hpp"

#include <array>

namespace voile
{

// clang-format off

// Parameters of a Fabric alone.
inline constexpr auto k_own_fabric_parameters = std::to_array<MaterialParameter<Fabric>>({
    {"areal_density", k_member<&Fabric::areal_density>, "kg/m^2", 1e-3f, 1e3f, "mass per area"},
    {"stretch_stiffness", {{"warp", k_member<&Fabric::stretch_stiffness, 0>},
                           {"weft", k_member<&Fabric::stretch_stiffness, 1>}}, "N/m", 1e-2f, 1e7f,
     "resistance to stretch, along the warp (rows) and the weft (columns)"},
    {"shear_stiffness", k_member<&Fabric::shear_stiffness>, "N/m", 0, 1e7f,
     "resistance to shear between warp and weft"},
    {"bending_stiffness", k_member<&Fabric::bending_stiffness>, "N m", 0, 1e3f, "resistance to folding, as of a plate"},
    {"damping_ratio", k_member<&Fabric::damping_ratio>, "", 0, 1, "fraction of the critical damping of each spring"},
});

// Parameters of a Material alone.
inline constexpr auto k_own_material_parameters = std::to_array<MaterialParameter<Material>>({
    {"vertex_mass", k_member<&Material::vertex_mass>, "kg", 1e-9f, 1e6f, "mass of a vertex inside the grid"},
    {"spring_stiffness",
     {
      {"structural_warp", k_member<&Material::springs, &SpringSet::structural_warp, &Spring::stiffness>},
      {"structural_weft", k_member<&Material::springs, &SpringSet::structural_weft, &Spring::stiffness>},
      {"shear", k_member<&Material::springs, &SpringSet::shear, &Spring::stiffness>},
      {"bend_warp", k_member<&Material::springs, &SpringSet::bend_warp, &Spring::stiffness>},
      {"bend_weft", k_member<&Material::springs, &SpringSet::bend_weft, &Spring::stiffness>},
      {"diagonal_bend", k_member<&Material::springs, &SpringSet::diagonal_bend, &Spring::stiffness>}},
     "N/m", 0, 1e7f, "of each family of springs"},
    {"spring_damping",
     {
      {"structural_warp", k_member<&Material::springs, &SpringSet::structural_warp, &Spring::damping>},
      {"structural_weft", k_member<&Material::springs, &SpringSet::structural_weft, &Spring::damping>},
      {"shear", k_member<&Material::springs, &SpringSet::shear, &Spring::damping>},
      {"bend_warp", k_member<&Material::springs, &SpringSet::bend_warp, &Spring::damping>},
      {"bend_weft", k_member<&Material::springs, &SpringSet::bend_weft, &Spring::damping>},
      {"diagonal_bend", k_member<&Material::springs, &SpringSet::diagonal_bend, &Spring::damping>}},
     "N s/m", 0, 1e6f, "of each family of springs"},
    {"border_scale", k_member<&Material::border_scale>, "", 0.1f, 1,
     "scale of masses, and of springs along the border, at the border of a grid; squared in a corner. "
     "1: all are alike. 0.5: a vertex has the mass of the area around it"},
    {"bending_stiffness", k_member<&Material::bending_stiffness>, "N m", 0, 1e3f,
     "of the isometric model, beside bend springs"},
    {"bending_time", k_member<&Material::bending_time>, "s", 0, 1, "damping of isometric bending per stiffness"},
    {"linear_drag", k_member<&Material::linear_drag>, "N s/m", 0, 1e6f,
     "force on each vertex per difference between wind and velocity"},
});

// Parameters of both. make_material copies them.
template <typename M>
inline constexpr auto k_common_parameters = std::to_array<MaterialParameter<M>>({
    {"thickness", k_member<&M::thickness>, "m", 1e-5f, 10,
     "distance that contact keeps between a vertex and a surface"},
    {"kinetic_friction", k_member<&M::kinetic_friction>, "", 0, k_most_friction, "Coulomb coefficient while it slips"},
    {"static_friction", k_member<&M::static_friction>, "", 0, k_most_friction,
     "Coulomb coefficient at rest; falls to kinetic_friction as the slip speed rises to 1 mm/s",
     {.least_name = "kinetic_friction", .least = k_member<&M::kinetic_friction>}},
    {"air_drag_normal", k_member<&M::air_drag_normal>, "", 0, 100,
     "C_n of the pressure 1/2 rho C_n u_n^2 along the normal, u = wind - velocity; 1.28 is a flat plate"},
    {"air_drag_tangential", k_member<&M::air_drag_tangential>, "", 0, 100,
     "C_t of the drag 1/2 rho C_t u_t^2 across the normal"},
    {"gravity_scale", k_member<&M::gravity_scale>, "", -10, 10, "times Step::gravity; 0: floats"},
    {"strain_limit", k_member<&M::strain_limit>, "", k_least_strain_limit, k_most_strain_limit, "largest l / L - 1 of a spring at the end of a step",
     {.or_zero = true}},
});

// clang-format on

inline constexpr auto k_fabric_parameters = parameter_path::join(k_own_fabric_parameters, k_common_parameters<Fabric>);
inline constexpr auto k_material_parameters =
    parameter_path::join(k_own_material_parameters, k_common_parameters<Material>);

// A member without a line above is an error here.
static_assert(sizeof(Fabric) == sizeof(float) * parameter_path::numbers(k_fabric_parameters) + sizeof(BendingModel));
static_assert(sizeof(Material) == sizeof(float) * parameter_path::numbers(k_material_parameters));

// The names of BendingModel's values, in their order.
inline constexpr std::array k_bending_models{"springs", "isometric"};

} // namespace voile
