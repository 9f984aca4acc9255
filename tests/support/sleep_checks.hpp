// Cloths that sleep, in tests.
#pragma once

#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/fastest.hpp"

#include <algorithm>
#include <functional>
#include <vector>

namespace tests
{

constexpr uint32_t k_sleep_frames = 30; // 0.5 s
constexpr voile::Step k_sleep_step{.duration = 1.f / 60, .substeps = 8};

inline uint32_t sleeping(ClothHarness& harness)
{
    return harness.statistics().sleeping_cloths;
}

// Steps until so many cloths sleep. The number of steps, or -1 if that takes more than `most`.
inline int steps_to_sleep(ClothHarness& harness, const voile::Step& step, int most, uint32_t cloths = 1)
{
    for (int i = 0; i < most; ++i)
    {
        harness.step(step);
        if (sleeping(harness) == cloths)
            return i + 1;
    }
    return -1;
}

// That steps leave the cloth as it is, to the bit, and that it sleeps.
inline void check_rests(
    ClothHarness& harness, voile::ClothId cloth, const voile::Step& step, uint32_t steps,
    const std::function<void()>& before = [] {})
{
    const auto positions = harness.positions(cloth);
    const auto normals = harness.normals(cloth);
    const auto velocities = harness.velocities(cloth);
    CHECK(fastest(velocities) == 0);
    for (uint32_t i = 0; i < steps; ++i)
    {
        before();
        harness.step(step);
        CHECK(sleeping(harness) >= 1);
        REQUIRE(same_bits(harness.positions(cloth), positions));
        CHECK(same_bits(harness.normals(cloth), normals));
        CHECK(same_bits(harness.velocities(cloth), velocities));
    }
}

// A sheet of 12 cm.
inline voile::GridCloth sleepy_sheet(float sleep_speed, float height = 0.003f,
                                     voile::Integrator integrator = voile::Integrator::verlet)
{
    voile::GridCloth grid = flat_sheet(7, 0.12f, height);
    grid.integrator = integrator;
    grid.sleep_speed = sleep_speed;
    return grid;
}

// A sheet that lies on the ground and sleeps.
struct Bed
{
    explicit Bed(const voile::GridCloth& grid = sleepy_sheet(0.01f), const voile::SolverOptions& options = {})
        : harness(options), cloth(voile::engine::take(harness.solver.add_cloth(grid))),
          ground(voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{})))
    {
        harness.upload();
        REQUIRE(steps_to_sleep(harness, k_sleep_step, 60) > 0);
    }

    ClothHarness harness;
    voile::ClothId cloth;
    voile::ColliderId ground;
};

} // namespace tests
