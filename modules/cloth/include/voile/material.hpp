// What a cloth is made of: a Fabric, by its own properties, or a Material, masses and springs outright. SI units.
#pragma once

#include "voile/gpu/result.hpp"

#include <array>
#include <variant>

namespace voile
{

using gpu::Error;
using gpu::Result;

// A spring pulls with stiffness * (length - rest length) + damping * (rate of lengthening).
struct Spring
{
    float stiffness = 0; // N/m, 0..1e7
    float damping = 0;   // N s/m, 0..1e6
};

// The four families of a grid's springs. A stiffness and damping of 0 leave a family out.
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
    springs,   // springs between vertices two apart: no stiffness near flat, more the sharper the fold
    isometric, // linear in the curvature, as a thin plate's (Bergou et al. 2006): follows a cantilever
};

// Everything that moves a vertex, with masses and spring constants given outright. The reference scene is given so; for
// a cloth that behaves the same at every resolution give a Fabric. On a mesh, the edges are structural_warp springs,
// those between the vertices opposite to an edge bend_warp springs, all alike; the other families are a grid's.
struct Material
{
    float vertex_mass = 0.01f; // kg, 1e-9..1e6; of a vertex inside the grid
    SpringSet springs{};
    // What a border has of the mass of an inner vertex, and of the springs along a row or column; twice over in a
    // corner. 1: masses and springs are all alike. 0.5: each vertex stands for the area around it, as make_material has
    // it. Grids only.
    float border_share = 1;        // 0.1..1
    float bending_stiffness = 0;   // N m, 0..1e3, of the isometric model, beside what bend springs do
    float bending_time = 0;        // s, 0..1: isometric bending is damped by as much times its stiffness
    float thickness = 0.005f;      // m, 1e-5..10; the distance that contact keeps between a vertex and a surface
    float static_friction = 0.4f;  // Coulomb, kinetic_friction..100
    float kinetic_friction = 0.4f; // Coulomb, >= 0
    float linear_drag = 0;         // N s/m a vertex, 0..1e6: force = linear_drag * (wind - velocity)
    float air_drag_normal = 0;     // C_n, 0..100: 1/2 rho A C_n |u_n| u_n along the normal, u = wind - velocity
    float air_drag_tangential = 0; // C_t, 0..100: 1/2 rho A C_t |u_t| u_t across the normal
    float strain_limit = 0;        // 0.001..10, the largest l / L - 1 at the end of a step; 0: none
};

// The strain limit acts at the end of each step, by corrections that keep linear momentum and take their energy from
// the cloth's own (shaders/cloth/limit_strain.comp, limit_scale.comp): none is added. Where it holds together what
// turns at omega, a step of h seconds takes up to (omega h)^2 / 2 of the angular momentum. Corrections undo what the
// step has stretched; beyond that, motion and damping pay for them. A grid whose springs alone would stretch to several
// times the limit stays below 1.2 times it as it swings down for a second, and hangs at rest within 1.03 times it.
// Where stiff springs are pressed together for it, less can be paid for: cotton that falls on a sphere from 0.1 m is
// stretched to 2 times a limit of 1 % for a moment and rests at 1.5 times it; of a limit of 0.1 % it is 21 times and 6
// times. On a mesh, where corrections have no coarse levels to travel on, the lower end of a very soft cloth follows
// over some steps: tethers help there.

// A fabric by its own properties, independent of the mesh that it is sampled with.
struct Fabric
{
    float areal_density = 0.15f;                        // kg/m^2, 1e-3..1e3
    std::array<float, 2> stretch_stiffness{1000, 1000}; // N/m, 1e-2..1e7; warp (along rows), weft (along columns)
    float shear_stiffness = 100;                        // N/m, 0..1e7, between warp and weft
    float bending_stiffness = 1e-5f;                    // N m, 0..1e3
    float damping_ratio = 0.02f;                        // of each spring's critical damping, 0..1
    float thickness = 0.005f;                           // m, 1e-5..10
    float static_friction = 0.5f;                       // Coulomb, kinetic_friction..100; falls to the kinetic one
                                                        // while the slip speed rises to 1 mm/s
    float kinetic_friction = 0.4f;                      // >= 0
    float air_drag_normal = 1.28f;                      // C_n, 0..100; a flat plate's
    float air_drag_tangential = 0.05f;                  // C_t, 0..100
    float strain_limit = 0;                             // 0.001..10, the largest l / L - 1 of a step; 0: none
    BendingModel bending_model = BendingModel::springs;
};

using ClothMaterial = std::variant<Fabric, Material>;

// The springs and masses of a grid with the given spacing (m, a along rows, b along columns), so that the fabric
// stretches as Fabric says whatever the spacing, and shears so where cells are not too oblong. From the energy of one
// cell under uniform strain:
// - diagonals carry the shear stiffness: k_d = K_s (a^2 + b^2) / (2 a b);
// - they also resist stretch, which structural springs therefore do less: with p = a / b, the stiffness A of a strip
//   along the warp that is held in its width solves A^2 - K_warp A - K_s^2 K_warp / K_weft = 0, and
//   k_warp = (A - K_s p^2) b / a, k_weft = (A K_weft / K_warp - K_s / p^2) a / b. Where the shear of oblong
//   cells is so stiff that one of these would be negative, it is 0, and K_s is what makes it so: cells 1 : 4 of cotton,
//   denim and leather stretch as the fabric does and shear more easily;
// - a bend spring two apart resists folding with k = B / (a b) per fold (from B kappa^2 / 2 of the strip, with the
//   spring's shortening as its measure: it has no stiffness near flat);
// - damping c = 2 * ratio * sqrt(k m / 2), a fraction of what is critical for two vertices of mass m on a spring;
// - the isometric model has no bend springs, and its fastest mode the same share of critical damping.
// Meshes have no springs along their edges. Each triangle resists as four springs in it do, along warp, weft and both
// diagonals: with stretched lengths w of unit vectors in these directions, its energy is its area times the sum of
// K / 2 (w - 1)^2, where K is A - K_s along the warp, A K_weft / K_warp - K_s along the weft (0 where that is negative)
// and 2 K_s along each diagonal. That is the energy of a grid of square cells, so stretch and shear stiffness are the
// fabric's on any triangles, and those of a grid. Damping is the same ratio on a grid of the mean spacing. Strain is
// uniform in a triangle: where edges run across warp and weft and triangles are as large as folds, the mesh resists
// shear that changes within a fold more than the fabric does, the more the stiffer stretch is against shear.
// MeshCloth::texture_coordinates say where warp and weft run. A vertex has a third of the mass of each triangle around
// it.
Material make_material(const Fabric& fabric, float spacing_along_row, float spacing_along_column);

// The constants of the reference scene: 0.15 kg a vertex, k = 400 N/m and c = 10 N s/m for all families, linear drag
// 0.1 N s/m, thickness 0.03 m, friction 0.4.
Material reference_material();

// Errors: a value outside the range given above, with its name and value.
Result<void> validate(const Material& material);
Result<void> validate(const Fabric& fabric);

} // namespace voile
