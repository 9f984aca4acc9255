// Coulomb friction: a patch on an incline, a strap that slides around a cylinder.
#include "physics/cases.hpp"
#include "physics/sheets.hpp"

#include <numbers>

namespace physics
{

namespace
{

// How far a patch moves down an incline of 30 degrees within 1 s.
double slid(double static_friction, double kinetic_friction, uint32_t side)
{
    const double angle = std::numbers::pi / 6;
    const glm::dvec3 normal(std::sin(angle), std::cos(angle), 0);
    const glm::dvec3 downhill(std::cos(angle), -std::sin(angle), 0);
    cloth::Fabric fabric = plain_fabric(500);
    fabric.shear_stiffness = 100;
    fabric.static_friction = static_cast<float>(static_friction);
    fabric.kinetic_friction = static_cast<float>(kinetic_friction);
    cloth::Grid grid;
    grid.integrator = cloth::Integrator::verlet;
    grid.columns = grid.rows = side;
    grid.width = grid.depth = 0.2f;
    grid.material = fabric;
    grid.transform[0] = glm::vec4(glm::vec3(downhill), 0);
    grid.transform[1] = glm::vec4(glm::vec3(normal), 0);
    grid.transform[3] = glm::vec4(glm::vec3(normal) * fabric.thickness, 1);
    Rig rig;
    const cloth::ClothId id = engine::take(rig.solver.add_cloth(grid));
    (void)engine::take(rig.solver.add_collider(cloth::PlaneCollider{.normal = glm::vec3(normal)}));
    rig.upload();
    const auto start = rig.positions(id);
    rig.step({.duration = 0.05f}, 20);
    const auto end = rig.positions(id);
    double mean = 0;
    for (size_t i = 0; i < start.size(); ++i)
        mean += glm::dot(end[i] - start[i], downhill) / static_cast<double>(start.size());
    return mean;
}

struct Mesh
{
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

// Joins consecutive pairs of vertices (one behind the other along z) by triangles.
void join_pairs(Mesh& mesh, uint32_t first, uint32_t second)
{
    mesh.triangles.emplace_back(first, first + 1, second);
    mesh.triangles.emplace_back(second, first + 1, second + 1);
}

// A closed cylinder about the z axis, its normals outwards.
Mesh cylinder(double radius, double half_length, uint32_t segments)
{
    Mesh mesh;
    for (uint32_t i = 0; i < segments; ++i)
    {
        const double angle = 2 * std::numbers::pi * i / segments;
        for (const double z : {-half_length, half_length})
            mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    mesh.positions.emplace_back(0, 0, -half_length);
    mesh.positions.emplace_back(0, 0, half_length);
    for (uint32_t i = 0; i < segments; ++i)
    {
        const uint32_t next = (i + 1) % segments;
        mesh.triangles.emplace_back(2 * i, 2 * next, 2 * i + 1);
        mesh.triangles.emplace_back(2 * next, 2 * next + 1, 2 * i + 1);
        mesh.triangles.emplace_back(2 * next, 2 * i, 2 * segments);
        mesh.triangles.emplace_back(2 * i + 1, 2 * next + 1, 2 * segments + 1);
    }
    return mesh;
}

constexpr double k_radius = 0.1; // m
constexpr float k_thickness = 0.002f;
constexpr uint32_t k_straight = 12; // links that hang on either side

// Lies over the upper half of the cylinder and hangs down 12 links on either side; a link is as wide as long.
Mesh strap_mesh(uint32_t links, double link)
{
    const double radius = k_radius + static_cast<double>(k_thickness);
    Mesh mesh;
    for (uint32_t i = 0; i <= links + 2 * k_straight; ++i)
    {
        const double s = static_cast<double>(i) - k_straight; // links from where it touches first
        const double on = std::min(std::max(s, 0.0), static_cast<double>(links));
        const double angle = std::numbers::pi * on / links;
        for (const double z : {-0.5 * link, 0.5 * link})
            mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle) - link * std::abs(s - on),
                                        z);
        if (i > 0)
            join_pairs(mesh, 2 * (i - 1), 2 * i);
    }
    return mesh;
}

// The tensions' ratio while the strap slides, the heavy weight going down, from how much its straight ends are
// stretched.
double tension_ratio(uint32_t links)
{
    const double link = std::numbers::pi * (k_radius + static_cast<double>(k_thickness)) / links;
    const Mesh strap = strap_mesh(links, link);
    const Mesh drum = cylinder(k_radius, 0.1, 512);
    cloth::MeshCloth mesh;
    mesh.positions = strap.positions;
    mesh.triangles = strap.triangles;
    mesh.integrator = cloth::Integrator::verlet;
    cloth::Fabric fabric = plain_fabric(20000);
    fabric.areal_density = 0.02f; // light: its own weight is 0.5 % of the lighter one
    fabric.thickness = k_thickness;
    fabric.static_friction = fabric.kinetic_friction = 0.3f;
    mesh.material = fabric;
    const auto vertices = static_cast<uint32_t>(strap.positions.size());
    mesh.inverse_masses.assign(vertices, static_cast<float>(1 / (0.02 * link * link * 0.5)));
    // Half of a weight a vertex: tensions of some 20 and 60 N/m, 0.1 and 0.3 % of stretch, whatever the link's width.
    for (const uint32_t i : {0u, 1u})
    {
        mesh.inverse_masses[i] = static_cast<float>(2 / (2.0 * link));
        mesh.inverse_masses[vertices - 1 - i] = static_cast<float>(2 / (8.0 * link));
    }
    Rig rig;
    const cloth::ClothId id = engine::take(rig.solver.add_cloth(mesh));
    (void)engine::take(
        rig.solver.add_collider(cloth::MeshCollider{.positions = drum.positions, .triangles = drum.triangles}));
    rig.upload();
    rig.step({.duration = 0.05f, .max_substeps = 100000});
    double light = 0;
    double heavy = 0;
    for (int sample = 0; sample < 40; ++sample)
    {
        rig.step({.duration = 0.0025f, .max_substeps = 100000});
        const auto x = rig.positions(id);
        // The four links next to the weights.
        light += glm::distance(x[0], x[8]) - 4 * link;
        heavy += glm::distance(x[vertices - 1], x[vertices - 9]) - 4 * link;
    }
    return heavy / light;
}

} // namespace

CaseResult incline(Detail detail)
{
    CaseResult result;
    const uint32_t side = detail == Detail::fine ? 9 : 3;
    // tan 30 degrees = 0.577.
    result.measurements.push_back(
        {"moved in 1 s, static friction 0.6, m", grid_size(side, side), slid(0.6, 0.5, side), 0, 1e-4});
    const double angle = std::numbers::pi / 6;
    result.measurements.push_back({"slid in 1 s, static 0.55, kinetic 0.5, m", grid_size(side, side),
                                   slid(0.55, 0.5, side), 0.5 * k_gravity * (std::sin(angle) - 0.5 * std::cos(angle)),
                                   0.01});
    return result;
}

CaseResult strap(Detail detail)
{
    CaseResult result;
    const uint32_t links = detail == Detail::fine ? 48 : 24;
    result.measurements.push_back({"T2 / T1, friction 0.3", std::to_string(links) + " links on the half circle",
                                   tension_ratio(links), std::exp(0.3 * std::numbers::pi), 0.03});
    return result;
}

} // namespace physics
