// Cloths that collide with themselves and with each other.
#include "support/cloth_harness.hpp"
#include "support/exact_intersections.hpp"

#include "voile/fabrics.hpp"

#include <doctest/doctest.h>

namespace
{

constexpr uint32_t k_side = 13;
constexpr float k_size = 0.3f;        // m
constexpr float k_thickness = 0.005f; // m

voile::GridCloth sheet(float height, float angle)
{
    voile::Fabric fabric = voile::cotton();
    fabric.thickness = k_thickness;
    voile::GridCloth grid;
    grid.columns = grid.rows = k_side;
    grid.width = grid.depth = k_size;
    grid.transform = glm::mat4(1.f);
    grid.transform[0] = {std::cos(angle), 0, std::sin(angle), 0};
    grid.transform[2] = {-std::sin(angle), 0, std::cos(angle), 0};
    grid.transform[3] = {0, height, 0, 1};
    grid.material = fabric;
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = true;
    return grid;
}

tests::ExactMesh mesh_of(tests::ClothHarness& harness, voile::ClothId cloth)
{
    const auto found = harness.solver.triangles(cloth);
    std::vector<glm::uvec3> triangles(found.begin(), found.end());
    std::vector<glm::vec3> positions;
    for (const glm::vec4& p : harness.positions(cloth))
        positions.emplace_back(p);
    return tests::exact_mesh(std::move(positions), std::move(triangles));
}

double lowest(const std::vector<glm::vec4>& positions)
{
    double least = 1e9;
    for (const glm::vec4& p : positions)
        least = std::min(least, static_cast<double>(p.y));
    return least;
}

} // namespace

TEST_CASE("a sheet that falls on another one comes to rest at the thickness from it, and they do not intersect")
{
    tests::ClothHarness harness;
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    const voile::ClothId lower = voile::engine::take(harness.solver.add_cloth(sheet(0.006f, 0)));
    const voile::ClothId upper = voile::engine::take(harness.solver.add_cloth(sheet(0.02f, 0.4f)));
    harness.upload();
    for (int frame = 0; frame < 20; ++frame)
    {
        harness.step({.duration = 1.f / 60});
        const tests::ExactMesh a = mesh_of(harness, lower);
        const tests::ExactMesh b = mesh_of(harness, upper);
        REQUIRE(tests::count_pairs_both_ways(a, b) == 0);
        REQUIRE(tests::count_pairs(a, a) == 0);
        REQUIRE(tests::count_pairs(b, b) == 0);
    }
    // Measured: 9.4 mm, because only the middle of the upper sheet lies on the lower one.
    const std::vector<glm::vec4> top = harness.positions(upper);
    const auto middle = static_cast<double>(top[top.size() / 2].y);
    CHECK(middle > 0.0085);
    CHECK(middle < 0.0105);
}

TEST_CASE("without self-collision a sheet falls through another one")
{
    tests::ClothHarness harness;
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    voile::GridCloth low = sheet(0.006f, 0);
    voile::GridCloth high = sheet(0.02f, 0.4f);
    low.self_collision = false;
    (void)voile::engine::take(harness.solver.add_cloth(low));
    const voile::ClothId upper = voile::engine::take(harness.solver.add_cloth(high));
    harness.upload();
    harness.step({.duration = 1.f / 60}, 20);
    CHECK(lowest(harness.positions(upper)) < 0.0051);
    CHECK(harness.positions(upper)[k_side * k_side / 2].y < 0.0051f);
}

TEST_CASE("a sheet that collides with itself falls freely as one that does not")
{
    tests::ClothHarness harness;
    const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(sheet(0, 0)));
    harness.upload();
    const std::vector<glm::vec4> before = harness.positions(cloth);
    harness.step({.duration = 1.f / 60, .air_density = 0}, 30);
    const std::vector<glm::vec4> after = harness.positions(cloth);
    const double fallen = 0.5 * 9.81 * 0.5 * 0.5;
    for (size_t i = 0; i < after.size(); ++i)
    {
        CHECK(static_cast<double>(before[i].y - after[i].y) == doctest::Approx(fallen).epsilon(2e-5));
        CHECK(std::abs(after[i].x - before[i].x) < 1e-6f);
    }
}
