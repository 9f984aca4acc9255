// The material of a cloth: a Fabric or a Material. SI units.
#pragma once

#include "voile/export.hpp"
#include "voile/result.hpp"

#include <array>
#include <string>
#include <variant>

namespace voile
{

// voile/material_parameters.hpp has the unit, range and meaning of each member. A value outside its range is an error.

// A spring pulls with stiffness * (length - rest length) + damping * (rate of lengthening).
struct Spring
{
    float stiffness = 0; // N/m
    float damping = 0;   // N s/m
};

// The families of a grid's springs. A family whose stiffness and damping are 0 is left out.
struct SpringSet
{
    Spring structural_warp; // neighbors along a row
    Spring structural_weft; // neighbors along a column
    Spring shear;           // diagonal neighbors
    Spring bend_warp;       // two apart along a row
    Spring bend_weft;       // two apart along a column
    Spring diagonal_bend;   // two apart along a diagonal
};

// How a cloth resists folding.
enum class BendingModel
{
    springs,   // springs between vertices two apart: no stiffness near flat, more in sharper folds
    isometric, // linear in the curvature, as a thin plate (Bergou et al. 2006): follows a cantilever
};

// A material described by the properties of its fabric. It behaves the same at every resolution.
struct Fabric
{
    float areal_density = 0.15f;
    std::array<float, 2> stretch_stiffness{1000, 1000}; // warp (along rows), weft (along columns)
    float shear_stiffness = 100;
    float bending_stiffness = 1e-5f;
    float damping_ratio = 0.02f;
    float thickness = 0.005f;
    float static_friction = 0.5f;
    float kinetic_friction = 0.4f;
    float air_drag_normal = 1.28f;
    float air_drag_tangential = 0.05f;
    float gravity_scale = 1;
    float strain_limit = 0;
    BendingModel bending_model = BendingModel::springs;
};

// A material described by masses and spring constants, as in the reference scene. On a mesh, edges are structural_warp
// springs, and bend_warp springs connect the two vertices opposite an edge. Only grids use the other families and
// border_scale.
struct Material
{
    float vertex_mass = 0.01f;
    SpringSet springs{};
    float border_scale = 1;
    float bending_stiffness = 0;
    float bending_time = 0;
    float thickness = 0.005f;
    float static_friction = 0.4f;
    float kinetic_friction = 0.4f;
    float linear_drag = 0;
    float air_drag_normal = 0;
    float air_drag_tangential = 0;
    float gravity_scale = 1;
    float strain_limit = 0;
};

// The strain limit acts at the end of each step. Its corrections conserve linear momentum and add no energy: they undo
// the stretch of the step, and any further correction costs kinetic energy or energy that damping has dissipated. They
// may reduce angular momentum, by up to (omega h)^2 / 2 per step of h seconds for cloth that spins at omega.
// - A grid whose springs alone would stretch to several times the limit stays below 1.2 times the limit while it swings
//   down for a second. At rest it hangs within 1.03 times the limit.
// - Cloth exceeds the limit for longer where corrections would compress stiff springs. Cotton that falls on a sphere
//   from 0.1 m stretches to 2 times a limit of 1 % for a moment, and rests at 1.5 times. With a limit of 0.1 % it
//   stretches to 21 times, and rests at 6 times.
// - On a mesh of a Fabric it limits the stretch of each triangle along warp, weft and both diagonals; on one of a
//   Material, that of its edges.
// - The coarse levels of a mesh, and of a grid with pins away from its borders, know the pins that it has when it is
//   uploaded. Pins that are set later hold less well.

using ClothMaterial = std::variant<Fabric, Material>;

// The springs and masses of a grid with the given spacing (m; a along rows, b along columns). The grid stretches like
// the fabric at any spacing, and shears like the fabric if its cells are not too oblong. The constants follow from the
// energy of one cell under uniform strain:
// - Diagonals carry the shear stiffness: k_d = K_s (a^2 + b^2) / (2 a b).
// - Diagonals also resist stretch, so structural springs resist it less. With p = a / b, the stiffness A of a strip
//   along the warp whose width is held solves A^2 - K_warp A - K_s^2 K_warp / K_weft = 0, and
//   k_warp = (A - K_s p^2) b / a, k_weft = (A K_weft / K_warp - K_s / p^2) a / b. If the shear of oblong cells is so
//   stiff that one of these would be negative, it is 0, and K_s is the value that makes it 0. Cells of 1 : 4 of cotton,
//   denim and leather stretch as the fabric does and shear more easily.
// - A bend spring between vertices two apart has k = B / (a b) per fold. This follows from B kappa^2 / 2 of the strip,
//   with curvature measured by the spring's shortening. The spring has no stiffness near flat.
// - Damping is c = 2 * ratio * sqrt(k m / 2), a fraction of the critical damping of two vertices of mass m on a spring.
// - The isometric model has no bend springs. Its fastest mode has the same fraction of critical damping.
//
// A mesh of a Fabric has no springs along its edges. Each triangle has four springs: along the warp, the weft and both
// diagonals. Its energy is its area times the sum of K / 2 (w - 1)^2, where w is the stretched length of a unit vector
// in each of these directions. K is A - K_s along the warp, A K_weft / K_warp - K_s along the weft (0 where that is
// negative) and 2 K_s along each diagonal. That is the energy of a grid of square cells, so stretch and shear stiffness
// are the fabric's on any triangles. Damping is that of a grid with the mean spacing and the same ratio. A vertex has a
// third of the mass of each triangle around it. Strain is uniform in a triangle. So if edges cross warp and weft and
// triangles are as large as folds, the mesh resists shear that changes within a fold more than the fabric does. The
// effect grows with the ratio of stretch stiffness to shear stiffness. MeshCloth::texture_coordinates give warp and
// weft.
VOILE_API Material make_material(const Fabric& fabric, float spacing_along_row, float spacing_along_column);

// The constants of the reference scene: 0.15 kg per vertex, k = 400 N/m and c = 10 N s/m for all families, linear drag
// 0.1 N s/m, thickness 0.03 m, friction 0.4.
VOILE_API Material reference_material();

// Errors: a value outside its range, with its name and value.
VOILE_API Result<void> validate(const Material& material);
VOILE_API Result<void> validate(const Fabric& fabric);

// Every parameter with its value and unit, in one line.
VOILE_API std::string to_string(const Material& material);
VOILE_API std::string to_string(const Fabric& fabric);

} // namespace voile
