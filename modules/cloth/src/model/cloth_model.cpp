// What grids and meshes have in common: validation, and the record that follows from a material.
#include "model/cloth_model.hpp"

#include "model/stability.hpp"

#include "shared/grid_springs.h"
#include "shared/pair_layout.h"
#include "shared/strain_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace voile
{

namespace
{

using glm::ivec2;
constexpr ivec2 k_spring_offsets[VOILE_SPRING_CLASSES] = {VOILE_SPRING_OFFSETS};

// Of the fastest mode and of the fastest decay.
struct Rates
{
    double omega_squared = 0;      // 1/s^2, in any shape
    double flat_omega_squared = 0; // 1/s^2, of the flat cloth
    double decay = 0;              // 1/s, in any shape
};

// A wave's factor from one vertex to the next, per line and over none, one and two of them.
using Phase = std::array<std::complex<double>, 3>;

Phase phase_of(double angle)
{
    const std::complex<double> one = std::polar(1.0, angle);
    return {1.0, one, one * one};
}

// The wave with the given phase per column and per row, on a grid without borders.
Rates wave_rates(const shared::ClothRecord& record, const glm::vec2& spacing, const Phase& column, const Phase& row)
{
    Rates rates;
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (int c = 0; c < VOILE_SPRING_CLASSES; ++c)
    {
        const ivec2& o = k_spring_offsets[c];
        const double factor =
            2 - 2 * std::real(column[static_cast<size_t>(o.x)] *
                              (o.y < 0 ? std::conj(row[static_cast<size_t>(-o.y)]) : row[static_cast<size_t>(o.y)]));
        const double stiffness = factor * static_cast<double>(record.springs[c].stiffness);
        const glm::dvec2 d = glm::normalize(glm::dvec2(o) * glm::dvec2(spacing));
        xx += stiffness * d.x * d.x;
        xy += stiffness * d.x * d.y;
        yy += stiffness * d.y * d.y;
        rates.omega_squared += stiffness;
        rates.decay += factor * static_cast<double>(record.springs[c].damping);
    }
    const double column_factor = 2 - 2 * column[1].real();
    const double row_factor = 2 - 2 * row[1].real();
    const double bending = static_cast<double>(record.bending.x) * column_factor * column_factor +
                           static_cast<double>(record.bending.y) * row_factor * row_factor +
                           static_cast<double>(record.bending.z) * column_factor * row_factor;
    rates.flat_omega_squared = largest_eigenvalue(xx, xy, yy) + bending;
    rates.omega_squared += bending;
    rates.decay += static_cast<double>(record.bending_time) * bending;
    return rates;
}

// Bounds for every shape that the grid can take. The energy of a spring is at most its tangent plus k/2
// |displacement|^2 whatever its direction and length, so the fastest mode is at most that of the scalar lattice with
// the same weights. With borders of half mass its modes are waves of an infinite lattice that are even about the
// borders. Borders with more mass have slower modes. Lighter ones are at most as much faster as their corners are
// lighter.
Rates grid_rates(const shared::ClothRecord& record, const glm::vec2& spacing, double inner_mass)
{
    constexpr int k_phases = 24; // a trigonometric polynomial of degree 2 exceeds its largest sample by 1.8 % at most
    std::array<Phase, k_phases + 1> phases;
    for (int i = 0; i <= k_phases; ++i)
        phases[static_cast<size_t>(i)] = phase_of(i * std::numbers::pi / k_phases);
    Rates largest;
    for (const Phase& column : phases)
        for (const Phase& row : phases)
        {
            const Rates rates = wave_rates(record, spacing, column, row);
            largest.omega_squared = std::max(largest.omega_squared, rates.omega_squared);
            largest.flat_omega_squared = std::max(largest.flat_omega_squared, rates.flat_omega_squared);
            largest.decay = std::max(largest.decay, rates.decay);
        }
    const double border = static_cast<double>(record.border_scale);
    const double lighter = std::max(1.0, 0.25 / (border * border));
    largest.omega_squared *= lighter / inner_mass;
    largest.flat_omega_squared *= lighter / inner_mass;
    largest.decay =
        (largest.decay * lighter + static_cast<double>(record.linear_drag) / (border * border)) / inner_mass;
    return largest;
}

// Verlet gains energy if modes of the flat cloth take up nearly all of its stability region. They may take up this
// fraction of it (bench/NOTES.md has the energies).
constexpr double k_flat_fraction = 0.75;

// 1/s^2, for the substeps.
double with_verlet_margin(const shared::ClothRecord& record, double omega_squared, double flat_omega_squared)
{
    return (record.flags & VOILE_CLOTH_VERLET) != 0 ? std::max(omega_squared, flat_omega_squared / k_flat_fraction)
                                                    : omega_squared;
}

shared::SpringClass spring_class(const Spring& spring, double rest_length)
{
    return {spring.stiffness, spring.damping, static_cast<float>(rest_length), 0};
}

// The coefficients of the isometric model on a grid: B b / a^3 for second differences along a row, B a / b^3 along a
// column, 2 B / (a b) for the twist of a cell. Its fastest mode alternates along rows and columns: 16, 16 and 16 times
// these.
glm::vec3 grid_bending(double stiffness, const glm::vec2& spacing)
{
    const auto a = static_cast<double>(spacing.x);
    const auto b = static_cast<double>(spacing.y);
    return {stiffness * b / (a * a * a), stiffness * a / (b * b * b), 2 * stiffness / (a * b)};
}

// Returns what vertices weigh, kg, inside the grid.
double apply_grid(const glm::vec2& spacing, const Material& m, shared::ClothRecord& record)
{
    const auto a = static_cast<double>(spacing.x);
    const auto b = static_cast<double>(spacing.y);
    const double diagonal = std::hypot(a, b);
    record.border_scale = m.border_scale;
    record.springs[0] = spring_class(m.springs.structural_warp, a);
    record.springs[1] = spring_class(m.springs.structural_weft, b);
    record.springs[2] = record.springs[3] = spring_class(m.springs.shear, diagonal);
    record.springs[4] = spring_class(m.springs.bend_warp, 2 * a);
    record.springs[5] = spring_class(m.springs.bend_weft, 2 * b);
    record.springs[6] = record.springs[7] = spring_class(m.springs.diagonal_bend, 2 * diagonal);
    record.bending = grid_bending(static_cast<double>(m.bending_stiffness), spacing);
    return static_cast<double>(m.vertex_mass);
}

void set_grid_rates(const glm::vec2& spacing, double mass, shared::ClothRecord& record)
{
    const Rates rates = grid_rates(record, spacing, mass);
    record.omega_squared =
        static_cast<float>(with_verlet_margin(record, rates.omega_squared, rates.flat_omega_squared));
    record.flat_omega_squared = static_cast<float>(rates.flat_omega_squared);
    record.decay = static_cast<float>(rates.decay);
}

// A mesh of triangles that resist as a fabric says: see membrane.hpp.
void apply_mesh_fabric(const MeshTopology& mesh, const Fabric& f, shared::ClothRecord& record)
{
    const auto density = static_cast<double>(f.areal_density);
    const double stretch =
        0.5 * (static_cast<double>(f.stretch_stiffness[0]) + static_cast<double>(f.stretch_stiffness[1]));
    const auto bending = static_cast<double>(f.bending_stiffness);
    const bool isometric = f.bending_model == BendingModel::isometric;
    const MembraneSprings membrane = make_membrane_springs(f, std::sqrt(mesh.mean_area));
    const auto constants_of = [&](float Spring::*constant) -> MembraneConstants
    {
        return {static_cast<double>(membrane.warp.*constant), static_cast<double>(membrane.weft.*constant),
                static_cast<double>(membrane.diagonal.*constant)};
    };
    const MembraneConstants stiffness = constants_of(&Spring::stiffness);
    std::vector<double> rates =
        membrane_rates(mesh.membrane, mesh.areas,
                       std::array{stiffness, constants_of(&Spring::damping), MembraneConstants{stiffness.warp, 0, 0},
                                  MembraneConstants{0, stiffness.weft, 0}});
    for (double& rate : rates)
        rate /= density;
    // Bend springs: damping in proportion to stiffness, 2 ratio sqrt(k m / 2) for a spring that stretches.
    const double time = 2 * static_cast<double>(f.damping_ratio) * std::sqrt(density * mesh.mean_area / (2 * stretch));
    const double opposite_omega_squared = (isometric ? 0 : bending) * mesh.fabric.opposite / density;
    const double bending_omega_squared = (isometric ? bending : 0) * mesh.fabric.bending / density;

    record.springs[VOILE_CLASS_EDGE] = spring_class({}, std::sqrt(mesh.mean_area));
    record.springs[VOILE_CLASS_WARP] = spring_class(membrane.warp, 1);
    record.springs[VOILE_CLASS_WEFT] = spring_class(membrane.weft, 1);
    record.springs[VOILE_CLASS_DIAGONAL] = spring_class(membrane.diagonal, 1);
    const double bend = isometric ? 0 : bending;
    record.springs[VOILE_CLASS_OPPOSITE] = {static_cast<float>(bend), static_cast<float>(bend * time), 0, 0};
    record.bending = glm::vec3(isometric ? f.bending_stiffness : 0, 0, 0);
    const double bending_time =
        bending_omega_squared > 0 ? 2 * static_cast<double>(f.damping_ratio) / std::sqrt(bending_omega_squared) : 0;
    record.bending_time = static_cast<float>(bending_time);
    const double threads = std::max(rates[2], rates[3]);
    const double omega_squared = rates[0] + opposite_omega_squared + bending_omega_squared;
    record.omega_squared = static_cast<float>(with_verlet_margin(record, omega_squared, threads));
    record.flat_omega_squared = record.omega_squared;
    record.decay = static_cast<float>(rates[1] + time * opposite_omega_squared + bending_time * bending_omega_squared);
}

void apply_mesh_material(const MeshTopology& mesh, const Material& m, shared::ClothRecord& record)
{
    const auto mass = static_cast<double>(m.vertex_mass);
    record.flags |= VOILE_CLOTH_UNIFORM_SPRINGS;
    record.springs[VOILE_CLASS_EDGE] = spring_class(m.springs.structural_warp, std::sqrt(mesh.mean_area));
    record.springs[VOILE_CLASS_OPPOSITE] = spring_class(m.springs.bend_warp, 0);
    record.bending = glm::vec3(m.bending_stiffness, 0, 0);
    const double bending = static_cast<double>(m.bending_stiffness) * mesh.uniform.bending / mass;
    const auto rate = [&](float edge, float opposite)
    {
        return (static_cast<double>(edge) * mesh.uniform.edge + static_cast<double>(opposite) * mesh.uniform.opposite) /
               mass;
    };
    record.omega_squared =
        static_cast<float>(rate(m.springs.structural_warp.stiffness, m.springs.bend_warp.stiffness) + bending);
    record.flat_omega_squared = record.omega_squared;
    record.decay =
        static_cast<float>(rate(m.springs.structural_warp.damping, m.springs.bend_warp.damping) +
                           static_cast<double>(m.linear_drag) / mass + static_cast<double>(m.bending_time) * bending);
}

// Of a correction by the strain limit: along one direction of a grid up to four springs act at once, two in line and
// their diagonals, and more than half of each correction would overshoot.
constexpr float k_strain_relaxation = 0.5f;

// Half of the narrowest level that limit_coarse.comp can take.
uint32_t grid_strain_spacing(const shared::ClothRecord& cloth)
{
    const auto lines = [](uint32_t all, uint32_t spacing) { return (all - 2 + spacing) / spacing + 1; };
    uint32_t spacing = 1;
    while (uint64_t{lines(cloth.columns, 2 * spacing)} * lines(cloth.rows, 2 * spacing) > VOILE_LIMIT_COARSE_VERTICES)
        spacing *= 2;
    return spacing;
}

// The members that both kinds of material have.
template <typename M>
void apply_surface(const M& m, shared::ClothRecord& record)
{
    record.thickness = m.thickness;
    record.static_friction = m.static_friction;
    record.kinetic_friction = m.kinetic_friction;
    record.drag_normal = m.air_drag_normal;
    record.drag_tangential = m.air_drag_tangential;
    record.gravity_scale = m.gravity_scale;
    record.strain_limit = m.strain_limit;
    record.strain_relaxation = k_strain_relaxation;
    record.strain_passes = VOILE_STRAIN_PASSES;
}

// The thickness of cloth from cloth is at most this part of the spacing of vertices, or neighbors in a flat cloth would
// repel each other, and no fold could close.
constexpr float k_thickest = 0.4f;
// Pairs are listed within this part of the thickness, or of the smallest height of a triangle.
constexpr float k_pair_thicknesses = 1.3f;
constexpr float k_pair_heights = 0.35f;
// Lists expect vertices to move. In a flat cloth that moves along its surface this part of the smallest height of its
// triangles is more than motion and range.
constexpr float k_flat = 0.8f;
constexpr float k_shortest_slide = 0.1f; // of the range
constexpr float k_longest_sweep = 1;

void set_pair_distances(const ClothModel& cloth, shared::ClothRecord& record)
{
    const glm::vec2 d = cloth.mesh ? glm::vec2(static_cast<float>(std::sqrt(cloth.mesh->mean_area))) : cloth.spacing;
    const float height = d.x * d.y / glm::length(d);
    record.pair_thickness = std::min(record.thickness, k_thickest * std::min(d.x, d.y));
    const float range = std::max(k_pair_thicknesses * record.pair_thickness, k_pair_heights * height);
    record.pair_range = range;
    record.pair_sweep = k_longest_sweep * range;
    record.pair_slide =
        std::clamp(k_flat * height - VOILE_FLAT_RANGE * range, k_shortest_slide * range, record.pair_sweep);
}

} // namespace

void set_strain_spacing(ClothModel& cloth)
{
    if (cloth.limit_levels)
        cloth.record.strain_spacing = 1u << (cloth.limit_levels->narrow - 1);
    else
        cloth.record.strain_spacing = cloth.mesh ? 1 : grid_strain_spacing(cloth.record);
}

double density(const ClothMaterial& material)
{
    if (const auto* fabric = std::get_if<Fabric>(&material))
        return static_cast<double>(fabric->areal_density);
    return static_cast<double>(std::get<Material>(material).vertex_mass);
}

bool bends_isometrically(const ClothMaterial& material)
{
    if (const auto* fabric = std::get_if<Fabric>(&material))
        return fabric->bending_model == BendingModel::isometric && fabric->bending_stiffness > 0;
    return std::get<Material>(material).bending_stiffness > 0;
}

void apply_material(ClothModel& cloth)
{
    shared::ClothRecord& record = cloth.record;
    const auto* fabric = std::get_if<Fabric>(&cloth.material);
    record.flags = cloth.integrator == Integrator::verlet ? VOILE_CLOTH_VERLET : 0;
    std::visit([&](const auto& m) { apply_surface(m, record); }, cloth.material);
    set_strain_spacing(cloth);
    record.linear_drag = fabric ? 0 : std::get<Material>(cloth.material).linear_drag;
    if (cloth.mesh && fabric)
        apply_mesh_fabric(*cloth.mesh, *fabric, record);
    else if (cloth.mesh)
    {
        record.bending_time = std::get<Material>(cloth.material).bending_time;
        apply_mesh_material(*cloth.mesh, std::get<Material>(cloth.material), record);
    }
    else
    {
        const Material material =
            fabric ? make_material(*fabric, cloth.spacing.x, cloth.spacing.y) : std::get<Material>(cloth.material);
        record.bending_time = material.bending_time;
        set_grid_rates(cloth.spacing, apply_grid(cloth.spacing, material, record), record);
    }
    // A mesh's vertex may have many more: what all of them make together stays below twice the correction.
    if (cloth.mesh)
        record.strain_relaxation = std::min(k_strain_relaxation, static_cast<float>(3.6 / cloth.mesh->uniform.edge));
    record.inverse_density = cloth.own_inverse_mass > 0 ? 1 : static_cast<float>(1 / density(cloth.material));
    record.pair_mass = cloth.heaviest > 0 ? 1 / (cloth.heaviest * record.inverse_density) : 0;
    if (bends_isometrically(cloth.material))
        record.flags |= VOILE_CLOTH_ISOMETRIC;
    if (cloth.self_collision)
        record.flags |= VOILE_CLOTH_SELF_COLLISION;
    set_pair_distances(cloth, record);
    if (cloth.own_inverse_mass > 0)
    {
        // The lightest vertex against what the material gives it.
        const auto lighter = static_cast<float>(std::max(cloth.own_inverse_mass * density(cloth.material), 1e-6));
        record.omega_squared *= lighter;
        record.flat_omega_squared *= lighter;
        record.decay *= lighter;
    }
}

Result<void> check_sleep_speed(const std::string& cloth, float speed)
{
    return check(subject("cloth", cloth), {"sleep_speed", speed, 0, k_most_sleep_speed, " m/s"});
}

Result<void> validate(const ClothInput& cloth, uint64_t vertices)
{
    const auto bad = [&](const std::string& reason) { return invalid("cloth", cloth.name, reason); };
    if (auto affine = check_affine(subject("cloth", cloth.name), cloth.transform); !affine)
        return affine;
    if (auto velocity = check(subject("cloth", cloth.name), "velocity", cloth.velocity, k_most_speed, " m/s");
        !velocity)
        return velocity;
    if (auto speed = check_sleep_speed(cloth.name, cloth.sleep_speed); !speed)
        return speed;
    if (auto integrator = check_enumerator(subject("cloth", cloth.name), "integrator",
                                           static_cast<int>(cloth.integrator), {"rk4", "verlet"});
        !integrator)
        return integrator;
    if (auto material = std::visit([](const auto& m) { return validate(m); }, cloth.material); !material)
        return bad(material.error().message);
    for (const uint32_t vertex : cloth.pins)
        if (vertex >= vertices)
            return bad("pinned vertex " + std::to_string(vertex) + " of " + std::to_string(vertices));
    if (!cloth.inverse_masses.empty() && cloth.inverse_masses.size() != vertices)
        return bad(std::to_string(cloth.inverse_masses.size()) + " inverse masses for " + std::to_string(vertices) +
                   " vertices");
    for (size_t i = 0; i < cloth.inverse_masses.size(); ++i)
        if (!(cloth.inverse_masses[i] >= 0) || cloth.inverse_masses[i] > k_most_inverse_mass)
            return bad("inverse mass " + std::to_string(i) + " is " + text(cloth.inverse_masses[i]) +
                       " 1/kg, must be 0 to " + text(k_most_inverse_mass));
    return {};
}

} // namespace voile
