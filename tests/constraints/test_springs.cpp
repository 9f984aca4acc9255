// Attachments that are springs: where they hold a vertex, and that it has no velocity there.
#include "support/airless_sheet.hpp"
#include "support/cloth_harness.hpp"

#include "voile/fabrics.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::airless_sheet;
using tests::ClothHarness;

constexpr double k_gravity = 9.81;

} // namespace

TEST_CASE("a spring holds a vertex at m g / k below its target")
{
    for (const float stiffness : {5.f, 5000.f}) // the second far beyond what the substep bears explicitly
    {
        CAPTURE(stiffness);
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(2);
        voile::Material material;
        material.vertex_mass = 0.02f; // nothing joins the vertices
        grid.material = material;
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        std::vector<voile::Attachment> attachments;
        for (uint32_t i = 0; i < 4; ++i)
            attachments.push_back(voile::spring(i, stiffness, 0.5f));
        voile::engine::take(harness.solver.set_attachments(id, attachments));
        harness.upload();
        harness.step({.substeps = 20}, 120);
        const double sag = 0.02 * k_gravity / static_cast<double>(stiffness);
        // Backward Euler is half of g h^2 ahead: 3.4e-6 m.
        for (const glm::vec4& x : harness.positions(id))
            CHECK(std::abs(2 - static_cast<double>(x.y) - sag) < 5e-6 + 1e-4 * sag);
    }
}

TEST_CASE("what hangs at rest on springs has no velocity")
{
    struct Case
    {
        voile::Integrator integrator;
        float stiffness; // N/m
        double fastest;  // m/s, measured: 2.9e-5, 2.3e-6, 3.9e-7, 1.5e-4, 6.1e-7
    };
    using enum voile::Integrator;
    for (const Case& item : {Case{verlet, 20, 1e-4}, Case{verlet, 2e3f, 1e-5}, Case{verlet, 1e6f, 1.9e-6},
                             Case{rk4, 2e3f, 7e-4}, Case{rk4, 1e6f, 3e-6}})
    {
        CAPTURE(item.stiffness);
        CAPTURE(static_cast<int>(item.integrator));
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(12);
        grid.width = grid.depth = 0.22f;
        grid.material = voile::cotton();
        grid.integrator = item.integrator;
        grid.transform = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}};
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        std::vector<voile::Attachment> attachments;
        for (uint32_t i = 0; i < grid.columns; ++i)
            attachments.push_back(voile::spring(i, item.stiffness, 1e-3f * item.stiffness));
        voile::engine::take(harness.solver.set_attachments(id, attachments));
        harness.upload();
        harness.step({}, 60);
        double fastest = 0; // of the attached vertices
        const std::vector<glm::vec4> velocities = harness.velocities(id);
        for (uint32_t i = 0; i < grid.columns; ++i)
            fastest = std::max(fastest, static_cast<double>(glm::length(glm::vec3(velocities[i]))));
        CHECK(fastest < item.fastest);
    }
}

TEST_CASE("softened cloth on springs hangs as still as on pins")
{
    for (const uint32_t substeps : {1u, 4u}) // it needs 590
    {
        CAPTURE(substeps);
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(6);
        grid.width = grid.depth = 0.1f;
        voile::Fabric fabric = voile::cotton();
        fabric.damping_ratio = 1;
        grid.material = fabric;
        grid.integrator = voile::Integrator::verlet;
        grid.transform = {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}, {0, 0, 0, 1}};
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        std::vector<voile::Attachment> attachments;
        for (uint32_t i = 0; i < grid.columns; ++i)
            attachments.push_back(voile::spring(i, 1000, 1));
        voile::engine::take(harness.solver.set_attachments(id, attachments));
        harness.upload();
        const std::vector<glm::vec4> start = harness.positions(id);
        harness.step({.max_substeps = substeps}, 60);
        const std::vector<glm::vec4> end = harness.positions(id);
        double fastest = 0;  // m/s
        double farthest = 0; // m, of the attached vertices
        for (uint32_t i = 0; i < grid.columns; ++i)
            farthest = std::max(farthest, static_cast<double>(glm::distance(glm::vec3(start[i]), glm::vec3(end[i]))));
        for (const glm::vec4& v : harness.velocities(id))
            fastest = std::max(fastest, static_cast<double>(glm::length(glm::vec3(v))));
        CHECK(fastest < 0.02);  // measured: 0.004; moved by the limit 0.67
        CHECK(farthest < 5e-6); // measured: 1.1e-6; moved by the limit 0.04
    }
}

// Where Verlet's substeps share contact, springs pulled vertices back as far as they had left.
TEST_CASE("springs to points inside a sphere hold no vertex there")
{
    for (const float stiffness : {20.f, 200.f})
    {
        CAPTURE(stiffness);
        ClothHarness harness;
        voile::GridCloth grid = airless_sheet(3);
        grid.width = grid.depth = 0.04f;
        voile::Material loose;
        loose.vertex_mass = 4e-5f;
        loose.thickness = 0.003f;
        grid.material = loose;
        grid.integrator = voile::Integrator::verlet;
        grid.transform = glm::mat4(1);
        const voile::ClothId id = voile::engine::take(harness.solver.add_cloth(grid));
        (void)voile::engine::take(
            harness.solver.add_collider(voile::SphereCollider{.center = {0, -0.04f, 0}, .radius = 0.05f}));
        std::vector<voile::Attachment> attachments;
        for (uint32_t i = 0; i < 9; ++i)
            attachments.push_back(voile::spring(i, stiffness, 0.01f * stiffness));
        voile::engine::take(harness.solver.set_attachments(id, attachments));
        harness.upload();
        harness.step({.substeps = 80}, 40);
        CHECK(harness.statistics().penetrating_vertices == 0); // 5 of 9
        for (const glm::vec4& v : harness.velocities(id))
            CHECK(glm::length(glm::vec3(v)) < 1e-5); // 0.24
    }
}
