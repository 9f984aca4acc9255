// Cloths that hit each other in free flight keep their momentum.
#include "support/cloth_meshes.hpp"
#include "support/momenta.hpp"
#include "support/pair_harness.hpp"
#include "support/random_cloths.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{

using tests::at;
using tests::PairHarness;
using tests::turned;
using voile::engine::take;

constexpr voile::Step k_empty_space{.duration = 1.f / 60, .gravity = {0, 0, 0}, .air_density = 0};

// The part of the momentum that is lost.
double lost(const tests::Momenta& before, const tests::Momenta& after)
{
    return glm::length(after.linear - before.linear) / before.speeds;
}

// The largest part of the momentum that is lost within `steps`. The cloths must meet.
double lost_momentum(PairHarness& harness, uint32_t steps)
{
    const tests::Momenta before = tests::momenta_of(harness);
    double speeds = before.speeds;
    double most = 0;
    for (uint32_t i = 0; i < steps; ++i)
    {
        harness.step(k_empty_space);
        const tests::Momenta after = tests::momenta_of(harness);
        most = std::max(most, lost(before, after));
        speeds = std::min(speeds, after.speeds);
    }
    CHECK(speeds < 0.95 * before.speeds);
    return most;
}

// J
double kinetic_energy(PairHarness& harness)
{
    double sum = 0;
    for (const voile::ClothId cloth : harness.cloths)
        sum += tests::motion_of(harness, cloth).energy;
    return sum;
}

} // namespace

TEST_CASE("sheets that hit each other keep their momentum, and become no faster")
{
    for (const float speed : {0.5f, 1.5f})
    {
        PairHarness harness;
        for (const float side : {-1.f, 1.f})
        {
            voile::GridCloth sheet = tests::pair_sheet(10, 10, 0.02f);
            sheet.transform = at({0.02f * side, 0.02f * side, 0}) * turned(0.2f * side, {0.1f, 1, 0.2f});
            sheet.velocity = {0, -speed * side, 0};
            harness.add(sheet);
        }
        harness.upload();
        const tests::Momenta before = tests::momenta_of(harness);
        harness.step(k_empty_space, 12);
        const tests::Momenta after = tests::momenta_of(harness);
        CAPTURE(speed);
        CHECK(after.speeds < 0.9 * before.speeds);              // they have met
        CHECK(lost(before, after) < (speed < 1 ? 4e-6 : 0.03)); // measured: 8e-7; at 1.5 m/s 1.2e-2 on an H200
        CHECK(harness.intersections() == 0);
    }
}

// Where they meet, a sweep of 3 ms has more pairs than a list has room for: without room, vertices lost their motion.
TEST_CASE("sheets that meet with vertices above vertices keep their momentum")
{
    PairHarness harness;
    for (const auto& [side, transform] :
         {std::pair(-1.f, at({-0.0023f, -0.03f, 0.01f}) * turned(0.0936f, {-0.024f, -0.43f, -0.903f})),
          {1.f, at({-0.019f, 0.03f, -0.012f}) * turned(0.193f, {-0.243f, 0.001f, -0.97f})}})
    {
        voile::GridCloth sheet = tests::pair_sheet(8, 8, 0.02f);
        sheet.transform = transform;
        sheet.velocity = {0, -1.16f * side, 0};
        harness.add(sheet);
    }
    harness.upload();
    const tests::Momenta before = tests::momenta_of(harness);
    harness.step(k_empty_space, 6);
    const tests::Momenta after = tests::momenta_of(harness);
    CHECK(after.speeds < 0.9 * before.speeds); // they have met
    CHECK(lost(before, after) < 0.02);         // it was 0.075
}

// What guards cut off is cut relative to the center of mass: relative to the mean of the vertices, silk took all
// momentum of leather eight times as heavy, and fine cloth that of coarse cloth.
TEST_CASE("sheets of different mass and spacing that meet keep their momentum")
{
    struct Sheet
    {
        voile::Fabric fabric;
        uint32_t rows;
        float spacing;
    };
    for (const auto& [lower, upper] : {std::pair(Sheet{voile::silk(), 8, 0.02f}, Sheet{voile::leather(), 8, 0.02f}),
                                       {Sheet{voile::cotton(), 5, 0.037f}, Sheet{voile::cotton(), 13, 0.012f}}})
    {
        const uint32_t rows = upper.rows;
        CAPTURE(rows);
        PairHarness harness;
        for (const auto& [side, of] : {std::pair(-1.f, lower), {1.f, upper}})
        {
            voile::GridCloth sheet = tests::pair_sheet(of.rows, of.rows, of.spacing);
            sheet.material = of.fabric;
            sheet.transform = at({0, 0.012f * side, 0});
            sheet.velocity = {0, -2 * side, 0};
            harness.add(sheet);
        }
        harness.upload();
        const tests::Momenta before = tests::momenta_of(harness);
        harness.step(k_empty_space, 4);
        CHECK(lost(before, tests::momenta_of(harness)) <
              (rows == lower.rows ? 4e-3 : 0.15)); // 1e-7; 8e-4, on an H200 0.077. It was 0.71 and 0.72
    }
}

// Until vertices that guards stop kept their velocity, scenes like these lost up to 23 %.
TEST_CASE("sheets that hit each other at any speed keep their momentum")
{
    for (const float speed : {4.f, 8.f})
        for (const float angle : {0.1f, 0.3f})
        {
            PairHarness harness;
            for (const float side : {-1.f, 1.f})
            {
                voile::GridCloth sheet = tests::pair_sheet(8, 8, 0.02f);
                sheet.transform = at({0.009f * side, 0.03f * side, 0.004f}) * turned(angle * side, {0.7f, 0.1f, -0.6f});
                sheet.velocity = {0, -0.5f * speed * side, 0};
                harness.add(sheet);
            }
            harness.upload();
            CAPTURE(speed);
            CAPTURE(angle);
            CHECK(lost_momentum(harness, 6) <
                  (speed < 5 ? 0.01 : 0.03)); // measured: 0.0022 and 0.018; they were 0.03 and 0.056
            CHECK(harness.intersections() == 0);
        }
}

// A vertex that guards stop stays as fast as at the last pass, relative to what carries it then. Relative to the mean
// until the next pass, the sheet that falls faster than both lost momentum: 0.03 of it at 1 g and 0.19 at 20 g.
TEST_CASE("sheets that meet in free fall lose no more momentum than without gravity, in few substeps")
{
    for (const auto integrator : {voile::Integrator::verlet, voile::Integrator::rk4})
        for (const float gravity : {9.81f, 196.2f})
        {
            CAPTURE(gravity);
            PairHarness harness;
            for (const float side : {-1.f, 1.f})
            {
                voile::GridCloth sheet = tests::pair_sheet(14, 14, 0.5f / 13);
                sheet.material = voile::cotton();
                sheet.transform = at({0.025f * side, 0.075f * side, 0.015f * side}) *
                                  turned(-0.1f * side, {1, 0.3f, 0.2f}) * turned(side > 0 ? 0.4f : 0, {0, 1, 0});
                sheet.velocity = {0, -side, 0};
                sheet.integrator = integrator;
                harness.add(sheet);
            }
            harness.upload();
            const tests::Momenta before = tests::momenta_of(harness);
            double mass = 0;
            for (const voile::ClothId cloth : harness.cloths)
                for (const glm::vec4& p : harness.positions(cloth))
                    mass += 1 / static_cast<double>(p.w);
            voile::Step step{.duration = 1.f / 60, .gravity = {0, -gravity, 0}, .air_density = 0};
            step.max_substeps = 6;
            harness.step(step, 14);
            const glm::dvec3 fallen(0, -mass * static_cast<double>(gravity) * 14 / 60, 0);
            const tests::Momenta after = tests::momenta_of(harness);
            CHECK(glm::length(after.linear - before.linear - fallen) < 0.015 * before.speeds); // measured: 0.005
            CHECK(harness.intersections() == 0);
        }
}

// Within 3 ms both move relative to the mean velocity, by mass. The light one is faster than its lists allow before
// they meet. It had the mean velocity then: 20 % of the momentum more, and 15 % of the energy.
TEST_CASE("a heavy sheet that hits a light one fast adds no momentum and no energy")
{
    for (const auto& scene : {std::pair(voile::Integrator::verlet, 30.f), std::pair(voile::Integrator::verlet, 50.f),
                              std::pair(voile::Integrator::rk4, 50.f)})
        for (const uint32_t most : {0u, 8u})
        {
            PairHarness harness;
            for (const float ratio : {1.f, 4.f})
            {
                voile::GridCloth sheet = tests::pair_sheet(5, 5, 0.02f);
                voile::Fabric fabric = voile::cotton();
                fabric.areal_density *= ratio;
                sheet.material = fabric;
                sheet.integrator = scene.first;
                sheet.transform = at({0.001f * ratio, 0.015f * ratio, 0.0005f * ratio});
                sheet.velocity = {0, ratio > 1 ? -scene.second : 0, 0};
                harness.add(sheet);
            }
            harness.upload();
            voile::Step step = k_empty_space;
            if (most > 0)
                step.max_substeps = most;
            const tests::Momenta before = tests::momenta_of(harness);
            const double energy = kinetic_energy(harness);
            harness.step(step, 6);
            CAPTURE(scene.second);
            CAPTURE(most);
            // Measured: 9e-5 to 2.1e-4; on a budget 2.6e-4 to 1.9e-3, on an H200 2.2e-3, at 40 to 60 m/s up to 4.5e-3.
            CHECK(lost(before, tests::momenta_of(harness)) < (most == 0 ? 1e-3 : 6e-3));
            CHECK(std::abs(kinetic_energy(harness) / energy - 0.8) <
                  0.003); // measured: 0.7994 to 0.8008; 0.8 if they stick
            CHECK(harness.intersections() == 0);
        }
}

TEST_CASE("meshes that hit each other keep their momentum")
{
    for (const float speed : {1.5f, 4.f})
    {
        PairHarness harness;
        for (const float side : {-1.f, 1.f})
        {
            tests::ClothMesh mesh = side < 0 ? tests::jittered_sheet(8, 8) : tests::jittered_sheet(10, 9);
            for (glm::vec3& p : mesh.positions)
                p = (side < 0 ? 0.4f : 0.32f) * glm::vec3(p.x - 0.18f, 0, p.z - 0.18f);
            voile::MeshCloth cloth = mesh.cloth();
            cloth.material = voile::cotton();
            cloth.integrator = voile::Integrator::verlet;
            cloth.self_collision = true;
            cloth.transform = at({0.002f, 0.012f * side, 0});
            cloth.velocity = {0, -0.5f * speed * side, 0};
            harness.add(cloth);
        }
        harness.upload();
        CAPTURE(speed);
        CHECK(lost_momentum(harness, 6) < 2e-7); // measured: 4.5e-8
        CHECK(harness.intersections() == 0);
    }
}
