// Coulomb friction on an incline of 30 degrees: patches of the presets that stick, slide, or lie near the threshold.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include "voile/fabrics.hpp"

#include <limits>
#include <numbers>
#include <random>

namespace physics
{

namespace
{

constexpr double k_angle = std::numbers::pi / 6; // tan = 0.57735
constexpr double k_patch = 0.08;                 // m, one side
constexpr double k_spacing = 0.1;                // m from patch to patch
constexpr double k_pressed = 5e-6; // m by which patches start inside their thickness: all vertices touch at once
constexpr double k_time = 0.25;    // s

glm::dvec3 incline_normal()
{
    return {std::sin(k_angle), std::cos(k_angle), 0};
}

glm::dvec3 downhill()
{
    return {std::cos(k_angle), -std::sin(k_angle), 0};
}

enum class Surface
{
    plane,
    coarse_mesh, // triangles longer than a patch
    fine_mesh,   // triangles a quarter as long as a patch
};

const char* const k_remark =
    "The presets' stretch, shear and density, with the named coefficients. The meshes are flat, with irregular "
    "triangles whose edges do not follow the motion: of 12 cm, longer than a patch, and of 2 cm, a quarter of a patch. "
    "Patches start 5 um inside their thickness, so that all vertices touch at once. The lowest friction that holds is "
    "the middle between the largest of 0.570, 0.572 ... with which a patch slid and the next one, so it is known to "
    "0.17 %.";

const char* name_of(Surface surface)
{
    return surface == Surface::plane ? "plane" : surface == Surface::coarse_mesh ? "coarse mesh" : "fine mesh";
}

// A square in the incline's plane of `cells` x `cells` pairs of triangles. Rotated by 0.4 rad, with its inner vertices
// moved by up to a fifth of a cell, so that no edge follows the motion and no two triangles are equal.
TriangleMesh incline_mesh(double side, uint32_t cells)
{
    constexpr double k_turn = 0.4;
    std::mt19937 random(1);
    const auto shift = [&] { return 0.4 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
    TriangleMesh mesh;
    for (uint32_t row = 0; row <= cells; ++row)
        for (uint32_t column = 0; column <= cells; ++column)
        {
            const double u = (column + shift()) / cells - 0.5;
            const double w = (row + shift()) / cells - 0.5;
            const double along = side * (std::cos(k_turn) * u - std::sin(k_turn) * w);
            const double across = side * (std::sin(k_turn) * u + std::cos(k_turn) * w);
            mesh.positions.emplace_back(along * downhill() + glm::dvec3(0, 0, across));
            if (row == cells || column == cells)
                continue;
            const uint32_t corner = row * (cells + 1) + column;
            mesh.triangles.emplace_back(corner, corner + cells + 1, corner + 1);
            mesh.triangles.emplace_back(corner + 1, corner + cells + 1, corner + cells + 2);
        }
    return mesh;
}

void add_surface(Rig& rig, Surface surface, double side)
{
    if (surface == Surface::plane)
    {
        (void)voile::engine::take(rig.solver.add_collider(voile::PlaneCollider{.normal = glm::vec3(incline_normal())}));
        return;
    }
    const double triangle = surface == Surface::coarse_mesh ? 1.5 * k_patch : 0.25 * k_patch;
    const TriangleMesh mesh = incline_mesh(side, static_cast<uint32_t>(side / triangle));
    (void)voile::engine::take(
        rig.solver.add_collider(voile::MeshCollider{.positions = mesh.positions, .triangles = mesh.triangles}));
}

voile::GridCloth patch(voile::Fabric fabric, double static_friction, double kinetic_friction, uint32_t side,
                       double across)
{
    fabric.static_friction = static_cast<float>(static_friction);
    fabric.kinetic_friction = static_cast<float>(kinetic_friction);
    voile::GridCloth grid;
    grid.integrator = voile::Integrator::verlet;
    grid.columns = grid.rows = side;
    grid.width = grid.depth = static_cast<float>(k_patch);
    grid.material = fabric;
    const glm::dvec3 position = (static_cast<double>(fabric.thickness) - k_pressed) * incline_normal() -
                                0.03 * downhill() + glm::dvec3(0, 0, across);
    grid.transform[0] = glm::vec4(glm::vec3(downhill()), 0);
    grid.transform[1] = glm::vec4(glm::vec3(incline_normal()), 0);
    grid.transform[3] = glm::vec4(glm::vec3(position), 1);
    return grid;
}

double mean_along(const std::vector<glm::dvec3>& positions, const glm::dvec3& direction)
{
    double mean = 0;
    for (const glm::dvec3& x : positions)
        mean += glm::dot(x, direction) / static_cast<double>(positions.size());
    return mean;
}

// The distances that patches beside each other slide within k_time, one per coefficient of static friction. The kinetic
// coefficient is 0.5.
std::vector<double> moved(Surface surface, const voile::Fabric& fabric, uint32_t side,
                          const std::vector<double>& static_friction)
{
    Rig rig;
    std::vector<voile::ClothId> ids;
    const double width = k_spacing * static_cast<double>(static_friction.size());
    for (size_t i = 0; i < static_friction.size(); ++i)
        ids.push_back(voile::engine::take(rig.solver.add_cloth(
            patch(fabric, static_friction[i], 0.5, side, k_spacing * (static_cast<double>(i) + 0.5) - 0.5 * width))));
    add_surface(rig, surface, 1.6 * width);
    rig.upload();
    std::vector<double> result;
    for (const voile::ClothId id : ids)
        result.push_back(-mean_along(rig.positions(id), downhill()));
    rig.step({.duration = static_cast<float>(k_time / 5), .air_density = 0}, 5);
    for (size_t i = 0; i < ids.size(); ++i)
        result[i] += mean_along(rig.positions(ids[i]), downhill());
    return result;
}

// The coefficient from which patches stay: the middle between one that slides and the next.
double threshold(const std::vector<double>& static_friction, const std::vector<double>& distances)
{
    for (size_t i = 0; i < distances.size(); ++i)
        if (std::abs(distances[i]) < 1e-3)
            return i == 0 ? 0 : 0.5 * (static_friction[i - 1] + static_friction[i]);
    return 0;
}

void measure(Surface surface, const char* name, Detail detail, CaseResult& result)
{
    const uint32_t side = detail == Detail::fine ? 9 : 5; // 1 and 2 cm between vertices
    const double exact = 0.5 * k_gravity * (std::sin(k_angle) - 0.5 * std::cos(k_angle)) * k_time * k_time;
    std::vector<double> coefficients;
    for (uint32_t i = 0; i < 9; ++i)
        coefficients.push_back(0.570 + 0.002 * i);
    std::vector<double> all = coefficients;
    all.insert(all.end(), {0.6, 0.5});
    std::vector<double> distances = moved(surface, *voile::find_fabric(name), side, all);
    const double slid = distances.back();
    const double stayed = distances[distances.size() - 2];
    distances.resize(coefficients.size());
    const std::string on = std::string(", ") + name + " on a " + name_of(surface);
    const std::string size = grid_size(side, side);
    result.measurements.push_back({"moved, static 0.6, m" + on, size, stayed, 0, 2e-9});
    result.measurements.push_back(
        {"slid, static and kinetic 0.5, m" + on, size, slid, exact, Target{5e-5, 1e-4}.at(detail)});
    result.measurements.push_back(
        {"lowest static friction that holds" + on, size, threshold(coefficients, distances), std::tan(k_angle), 0.01});
}

} // namespace

CaseResult incline(Detail detail)
{
    CaseResult result;
    for (const char* name : {"silk", "cotton", "wool", "denim", "leather"})
        measure(Surface::plane, name, detail, result);
    measure(Surface::coarse_mesh, "cotton", detail, result);
    measure(Surface::fine_mesh, "cotton", detail, result);
    result.remark = k_remark;
    return result;
}

} // namespace physics
