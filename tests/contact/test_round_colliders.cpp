// Cloth that is coarse for something round, as a curtain for the capsule of a character, slides around it and off it.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/fabrics.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <doctest/doctest.h>

#include <algorithm>

namespace
{

using tests::ClothHarness;
using voile::engine::take;

struct Walk
{
    float speed;       // m/s
    uint32_t substeps; // per 1/60 s, at most; 32 are all
    float friction;
    bool self_collision;
    float most; // of the stretch; before: 5.8, 5.9, 5.6, 2.5, 4.5
};

struct Stretches
{
    float most;
    float end;
};

// A curtain of 1.5 m x 1.8 m with 85 mm between its vertices, pinned along its top. A capsule of 0.3 m walks through
// it, and 3 m on.
Stretches walk_through(const Walk& walk)
{
    constexpr uint32_t k_columns = 18;
    constexpr float k_duration = 1.f / 60;
    constexpr float k_before = 2; // m
    constexpr float k_behind = 3; // m
    ClothHarness harness;
    voile::GridCloth grid;
    grid.columns = k_columns;
    grid.rows = 22;
    grid.width = 1.5f;
    grid.depth = 1.8f;
    voile::Fabric fabric = voile::cotton();
    fabric.air_drag_normal = fabric.air_drag_tangential = 0;
    grid.material = fabric;
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = walk.self_collision;
    grid.transform = tests::moved({0, 1.1f, 0}) * glm::rotate(glm::mat4(1), glm::radians(90.f), {1, 0, 0});
    for (uint32_t column = 0; column < k_columns; ++column)
        grid.pins.push_back(column);
    (void)take(harness.solver.add_cloth(grid));
    const float z = -k_before - 0.3f;
    const voile::ColliderId player = take(
        harness.solver.add_collider(voile::CapsuleCollider{.from = {0.05f, 0.3f, z},
                                                           .to = {0.05f, 1.35f, z},
                                                           .radius = 0.3f,
                                                           .friction = voile::Friction{walk.friction, walk.friction}}));
    harness.upload();
    Stretches found{};
    const auto frames = static_cast<int>((k_before + k_behind) / (walk.speed * k_duration));
    for (int i = 1; i <= frames; ++i)
    {
        const float at = walk.speed * k_duration * static_cast<float>(i);
        take(harness.solver.move_collider(player, tests::moved({0, 0, at})));
        harness.step({.duration = k_duration, .max_substeps = walk.substeps});
        const voile::Statistics now = harness.statistics();
        CHECK(now.penetrating_vertices == 0);
        found.end = now.max_stretch;
        found.most = std::max(found.most, found.end);
    }
    return found;
}

} // namespace

TEST_CASE("a character walks through a curtain, which slides off it instead of being carried along")
{
    for (const Walk& walk : {Walk{5, 2000, 0, false, 0.3f}, Walk{3, 16, 0, false, 0.4f}, Walk{1.5f, 16, 0, false, 0.3f},
                             Walk{3, 16, 0.3f, false, 1}, Walk{5, 2000, 0.3f, true, 0.4f}})
    {
        CAPTURE(walk.speed);
        CAPTURE(walk.substeps);
        CAPTURE(walk.friction);
        const Stretches found = walk_through(walk);
        MESSAGE("stretch at most " << found.most << ", at the end " << found.end);
        CHECK(found.most < walk.most);
        CHECK(found.end < 0.1f);
    }
}
