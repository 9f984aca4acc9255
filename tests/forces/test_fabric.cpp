// Fabrics against exact values: a hanging sheet, a falling plate. The same fabric on grids of different spacing. The
// physics report has more (tests/physics).
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"

#include "voile/fabrics.hpp"
#include "voile/material_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace
{

using tests::ClothHarness;

constexpr double k_gravity = 9.81;

// Hangs in the plane of x and y. Its row 0 is pinned on top at y = 0.
voile::GridCloth hanging_sheet(uint32_t columns, uint32_t rows, float width, float length, const voile::Fabric& fabric)
{
    voile::GridCloth grid;
    grid.columns = columns;
    grid.rows = rows;
    grid.width = width;
    grid.depth = length;
    grid.transform[1] = {0, 0, 1, 0}; // grid z to -y
    grid.transform[2] = {0, -1, 0, 0};
    grid.transform[3] = {0, -0.5f * length, 0, 1};
    grid.material =
        voile::make_material(fabric, width / static_cast<float>(columns - 1), length / static_cast<float>(rows - 1));
    for (uint32_t column = 0; column < columns; ++column)
        grid.pins.push_back(column);
    return grid;
}

voile::Fabric still_air(float shear)
{
    voile::Fabric fabric;
    fabric.areal_density = 0.2f;
    fabric.stretch_stiffness = {1000, 1000};
    fabric.shear_stiffness = shear;
    fabric.bending_stiffness = 0;
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    return fabric;
}

// How far the center of a hanging sheet's lower edge lies below the sheet's length, relative to that length.
double elongation(uint32_t columns, uint32_t rows, float width, float shear)
{
    voile::Fabric fabric = still_air(shear);
    fabric.damping_ratio = 0.3f;
    voile::GridCloth grid = hanging_sheet(columns, rows, width, 1, fabric);
    tests::raw(grid).linear_drag = 40 * tests::raw(grid).vertex_mass; // near critical for the slowest stretch, 17 Hz
    ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
    harness.upload();
    harness.step({.duration = 0.1f}, 6);
    return -static_cast<double>(harness.positions(id)[size_t{columns} * (rows - 1) + columns / 2].y) - 1;
}

} // namespace

TEST_CASE("a hanging sheet stretches by rho g L / 2k, on every grid")
{
    const double exact = 0.2 * k_gravity / (2 * 1000); // 0.0981 %
    for (const uint32_t side : {5u, 9u, 17u})
    {
        CAPTURE(side);
        // Float positions near 1 m: 6e-8 of 1e-3, plus the motion left after 0.6 s.
        CHECK(std::abs(elongation(side, side, 1, 0) / exact - 1) < 2e-3);
    }
    // With shear stiffness, a strip three square cells wide keeps its width only near the top.
    CHECK(std::abs(elongation(4, 33, 3.f / 32, 300) / exact - 1) < 0.02);
    // The diagonals of cells 1 : 4 alone would be 4 times as stiff.
    CHECK(std::abs(elongation(4, 5, 3.f / 16, 300) / exact - 1) < 0.02);
    CHECK(std::abs(elongation(2, 33, 1.f / 8, 300) / exact - 1) < 0.02);
    const double coarse = elongation(9, 9, 1, 300);
    const double fine = elongation(17, 17, 1, 300);
    CHECK(std::abs(fine / coarse - 1) < 0.02);
}

TEST_CASE("a plate that falls face on reaches its terminal speed")
{
    voile::Fabric fabric = still_air(100);
    fabric.air_drag_normal = 1.28f;
    for (const uint32_t side : {4u, 13u})
    {
        voile::GridCloth grid;
        grid.columns = grid.rows = side;
        grid.width = grid.depth = 0.5f;
        grid.material =
            voile::make_material(fabric, 0.5f / static_cast<float>(side - 1), 0.5f / static_cast<float>(side - 1));
        ClothHarness harness;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        harness.upload();
        harness.step({.duration = 0.1f}, 15); // nine times v / g
        const double exact = std::sqrt(2 * 0.2 * k_gravity / (1.225 * 1.28));
        CHECK(exact == tests::close_to(1.58, 0.005));
        for (const glm::vec4& v : harness.velocities(id))
        {
            CHECK(std::abs(-static_cast<double>(v.y) / exact - 1) < 1e-3); // borders and corners too: the plate stays
                                                                           // flat
            CHECK(std::abs(static_cast<double>(v.x) / exact) < 1e-3);
        }
    }
}

namespace
{

// What validate says of each number of a material below and above its range, and of one that is no number.
template <typename M, size_t N>
void check_ranges(const char* what, const std::array<voile::MaterialParameter<M>, N>& parameters)
{
    for (const voile::MaterialParameter<M>& parameter : parameters)
        for (const voile::ParameterComponent<M>& component : parameter.components())
            for (const float value : {parameter.min - 1, 2 * parameter.max, std::nanf("")})
            {
                M material;
                component.member.ref(material) = value;
                const auto result = voile::validate(material);
                CAPTURE(parameter.name);
                REQUIRE_FALSE(result);
                const std::string start = std::string(what) + ": " + parameter.name +
                                          (*component.name != '\0' ? " (" + std::string(component.name) + ")" : "");
                if (parameter.name == std::string("kinetic_friction") && value > parameter.max)
                    continue; // above the static one as well
                CHECK(result.error().message.starts_with(start + " is "));
                CHECK(result.error().message.find(", must be ") != std::string::npos);
            }
}

} // namespace

TEST_CASE("gravity_scale multiplies the gravity of a cloth, to the bit, and that of no other")
{
    for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
        for (const float strain_limit : {0.f, 0.01f})
        {
            CAPTURE(strain_limit);
            const auto sheets = [&](ClothHarness& harness, std::initializer_list<float> scales)
            {
                std::vector<voile::ClothId> ids;
                for (const float scale : scales)
                {
                    voile::Fabric fabric = still_air(300);
                    fabric.strain_limit = strain_limit;
                    fabric.gravity_scale = scale;
                    voile::GridCloth grid = hanging_sheet(7, 9, 0.6f, 0.8f, fabric);
                    grid.material = fabric;
                    grid.integrator = integrator;
                    ids.push_back(voile::engine::take(harness.solver.add_cloth(grid)));
                }
                harness.upload();
                return ids;
            };
            ClothHarness scaled;
            const auto ids = sheets(scaled, {-0.5f, 0, 1, 2});
            scaled.step({.substeps = 40}, 6);
            for (const auto& [id, scale] : {std::pair{ids[0], -0.5f}, std::pair{ids[1], 0.f}, std::pair{ids[3], 2.f}})
            {
                ClothHarness plain;
                const auto other = sheets(plain, {1});
                plain.step({.substeps = 40, .gravity = {0, scale * -9.81f, 0}}, 6);
                CHECK(scaled.positions(id) == plain.positions(other[0]));
                CHECK(scaled.velocities(id) == plain.velocities(other[0]));
            }
            CHECK(scaled.velocities(ids[2])[60].y < 0);
        }
}

TEST_CASE("a parameter that is out of its range is refused by its name")
{
    check_ranges("fabric", voile::k_fabric_parameters);
    check_ranges("material", voile::k_material_parameters);
    CHECK(voile::validate(voile::Fabric{.static_friction = 0.3f, .kinetic_friction = 0.4f}).error().message ==
          "fabric: static_friction is 0.3, must be at least kinetic_friction, 0.4");
    CHECK(voile::validate(voile::Fabric{.strain_limit = 1e-4f}).error().message ==
          "fabric: strain_limit is 0.0001, must be 0.001 to 10, or 0 for none");
}

TEST_CASE("a material is printed with every parameter, its value and its unit")
{
    const std::string fabric = voile::to_string(voile::Fabric{});
    CHECK(fabric.starts_with("areal_density 0.15 kg/m^2, "));
    CHECK(fabric.ends_with(", bending_model springs"));
    for (const auto& parameter : voile::k_fabric_parameters)
        CHECK(fabric.find(std::string(parameter.name) + " ") != std::string::npos);
    CHECK(voile::to_string(voile::reference_material()).find("spring_damping 10 10 10 10 10 10 N s/m") !=
          std::string::npos);
}

TEST_CASE("every preset is found by name, is valid, and keeps its stretch and shear on a grid")
{
    for (const char* name : {"silk", "cotton", "wool", "denim", "leather"})
    {
        CAPTURE(name);
        const auto fabric = voile::find_fabric(name);
        REQUIRE(fabric);
        CHECK(voile::validate(*fabric));
        CHECK(fabric->static_friction >= fabric->kinetic_friction);
        CHECK(fabric->bending_model == voile::BendingModel::isometric);
        // Shear must not be so stiff that the structural springs vanish, because they leave to the diagonals what these
        // resist.
        const voile::Material material = voile::make_material(*fabric, 0.01f, 0.01f);
        CHECK(material.springs.structural_warp.stiffness > 0);
        CHECK(material.springs.structural_weft.stiffness > 0);
    }
    CHECK_FALSE(voile::find_fabric("chiffon"));
    CHECK_FALSE(voile::find_fabric(""));
}
