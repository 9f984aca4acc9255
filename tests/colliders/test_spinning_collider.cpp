// A lump with ears that spins under a sheet: a mesh of many triangles whose surface moves, with friction.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/crossing_checks.hpp"
#include "support/hard_shapes.hpp"

#include "voile/fabrics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace
{

constexpr uint32_t k_frames = 24;
constexpr double k_rounding = 2e-6; // m, for float coordinates near 1, rotated by the motion

voile::GridCloth sheet_above_the_ears()
{
    voile::GridCloth grid = tests::flat_sheet(36, 1.5f, 0.62f);
    voile::Fabric fabric = voile::cotton();
    for (float& stiffness : fabric.stretch_stiffness)
        stiffness *= 0.25f;
    grid.material = fabric;
    grid.integrator = voile::Integrator::verlet;
    grid.velocity = {0, -2, 0};
    return grid;
}

std::vector<glm::dvec3> in_space_of(const glm::mat4& motion, const std::vector<glm::vec4>& positions)
{
    const glm::dmat4 back = glm::inverse(glm::dmat4(motion));
    std::vector<glm::dvec3> result;
    result.reserve(positions.size());
    for (const glm::vec4& p : positions)
        result.emplace_back(back * glm::dvec4(glm::dvec3(p), 1));
    return result;
}

// About y, rad/s: angular momentum over moment of inertia.
double angular_velocity(const std::vector<glm::vec4>& x, const std::vector<glm::vec4>& v)
{
    double momentum = 0;
    double inertia = 0;
    for (size_t i = 0; i < x.size(); ++i)
    {
        momentum += static_cast<double>(x[i].z * v[i].x - x[i].x * v[i].z);
        inertia += static_cast<double>(x[i].x * x[i].x + x[i].z * x[i].z);
    }
    return momentum / inertia;
}

} // namespace

TEST_CASE("a spinning lump with ears turns the sheet on it, and no vertex enters it")
{
    const voile::engine::Mesh lump = tests::lump_with_ears(48);
    REQUIRE(lump.triangles.size() > 5000);
    tests::ClothHarness harness;
    const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(sheet_above_the_ears()));
    const voile::ColliderId with = voile::engine::take(harness.solver.add_collider(tests::collider(lump)));
    harness.upload();
    const tests::CrossingCheck crossings(lump, harness.solver.triangles(id));
    REQUIRE(crossings.distance().closed());
    tests::Crossings worst;
    double deepest = 0;
    for (uint32_t frame = 1; frame <= k_frames; ++frame)
    {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(frame) / 60; // one turn per second
        const glm::mat4 motion = glm::rotate(glm::mat4(1.f), angle, glm::vec3(0, 1, 0));
        REQUIRE(harness.solver.move_collider(with, motion));
        harness.step({});
        const auto positions = in_space_of(motion, harness.positions(id));
        for (const glm::dvec3& p : positions)
        {
            REQUIRE(std::isfinite(p.x + p.y + p.z));
            deepest = std::max(deepest, -crossings.distance().nearest(p).signed_distance);
        }
        const tests::Crossings now = crossings.count(positions);
        if (now.count() > worst.count())
            worst = now;
    }
    CHECK(deepest < k_rounding);
    const voile::Statistics statistics = harness.statistics();
    CHECK(statistics.nan_vertices == 0);
    CHECK(statistics.contacts > 0);
    CHECK(angular_velocity(harness.positions(id), harness.velocities(id)) > 0.5);
    MESSAGE("edges of the lump through ", worst.collider_edges, " triangles, of the cloth through ", worst.cloth_edges,
            ", depth ", worst.depth, " m; deepest vertex ", deepest, " m");
}
