// Colliders that change at run time: removed, disabled, and with other layers, friction or radius.
#include "support/close_to.hpp"
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <cmath>

namespace
{

using tests::ClothHarness;
using tests::flat_sheet;
using tests::moved;
using tests::reason;
using voile::engine::take;

constexpr float k_frame = 1.f / 60; // s
constexpr float k_gravity = 9.81f;  // m/s^2

} // namespace

TEST_CASE("cloth falls when what it lies on is removed, disabled or given other layers")
{
    for (const int how : {0, 1, 2, 3})
    {
        CAPTURE(how);
        ClothHarness harness;
        voile::Solver& solver = harness.solver;
        voile::GridCloth grid = flat_sheet(6, 0.5f, 0);
        grid.transform = moved({0, tests::fabric_of(grid).thickness, 0});
        const voile::ClothId sheet = take(solver.add_cloth(grid));
        const voile::engine::Mesh table = voile::engine::make_ground(1);
        const voile::ColliderId top = how < 3 ? take(solver.add_collider(tests::collider(table)))
                                              : take(solver.add_collider(tests::deforming(table)));
        harness.upload();
        harness.step({}, 20);
        const auto lying = harness.positions(sheet);
        CHECK(harness.statistics().contacts == 36);
        switch (how)
        {
        case 1:
            take(solver.set_enabled(top, false));
            break;
        case 2:
            take(solver.set_layers(top, 0));
            break;
        default:
            take(solver.remove(top));
            break;
        }
        CHECK_FALSE(solver.needs_upload());
        constexpr int k_steps = 10;
        harness.step({}, k_steps);
        const float time = k_steps * k_frame;
        const float fallen = lying[14].y - harness.positions(sheet)[14].y;
        CHECK(fallen == tests::close_to(0.5f * k_gravity * time * time, 1e-4));
        CHECK(harness.statistics().contacts == 0);
        if (how == 1)
        {
            take(solver.set_enabled(top, true)); // 12 cm above the sheet: it falls on
            harness.step({}, k_steps);
            CHECK(lying[14].y - harness.positions(sheet)[14].y == tests::close_to(2 * k_gravity * time * time, 1e-4));
        }
    }
}

TEST_CASE("friction of a collider changes while cloth slides on it")
{
    const auto slide = [](bool rough)
    {
        ClothHarness harness;
        voile::GridCloth grid = flat_sheet(6, 0.5f, 0);
        grid.transform = moved({0, tests::fabric_of(grid).thickness, 0});
        grid.velocity = {1, 0, 0};
        tests::fabric_of(grid).static_friction = tests::fabric_of(grid).kinetic_friction = 0.5f;
        const voile::ClothId sheet = take(harness.solver.add_cloth(grid));
        const voile::ColliderId ground =
            take(harness.solver.add_collider(voile::PlaneCollider{.friction = voile::Friction{0, 0}}));
        harness.upload();
        harness.step({}, 5);
        CHECK(harness.velocities(sheet)[14].x == tests::close_to(1, 1e-3));
        if (rough)
            take(harness.solver.set_friction(ground, voile::Friction{0.5f, 0.5f}));
        harness.step({}, 6);
        return harness.velocities(sheet)[14].x;
    };
    CHECK(slide(false) == tests::close_to(1, 1e-3));
    CHECK(slide(true) == tests::close_to(1 - 0.5f * k_gravity * 6 * k_frame, 5e-3));
    ClothHarness harness;
    const voile::ColliderId plane = take(harness.solver.add_collider(voile::PlaneCollider{}));
    CHECK(reason(harness.solver.set_friction(plane, voile::Friction{-1, 0})).starts_with("collider 0: "));
    CHECK(reason(harness.solver.set_radius(plane, 1)) ==
          "collider 0 has no radius: it is neither a sphere nor a capsule");
}

TEST_CASE("a ball and a capsule that grow lift the cloth on them, and shrink away from it")
{
    for (const bool capsule : {false, true})
    {
        CAPTURE(capsule);
        ClothHarness harness;
        voile::Solver& solver = harness.solver;
        const voile::ClothId sheet = take(solver.add_cloth(flat_sheet(12, 0.6f, 0.25f)));
        const voile::ColliderId body = capsule ? take(solver.add_collider(voile::CapsuleCollider{
                                                     .from = {-0.2f, 0, 0}, .to = {0.2f, 0, 0}, .radius = 0.2f}))
                                               : take(solver.add_collider(voile::SphereCollider{.radius = 0.2f}));
        harness.upload();
        harness.step({}, 20);
        const auto top = [&]
        {
            float highest = -1;
            for (const glm::vec4& p : harness.positions(sheet))
                highest = std::max(highest, p.y);
            return highest;
        };
        const float before = top();
        for (int i = 1; i <= 10; ++i)
        {
            take(solver.set_radius(body, 0.2f + 0.005f * static_cast<float>(i)));
            if (solver.needs_upload())
                harness.upload();
            harness.step({});
        }
        harness.step({}, 10);
        CHECK(top() - before > 0.045f);
        CHECK(harness.statistics().penetrating_vertices == 0);
        take(solver.set_radius(body, 0.1f));
        if (solver.needs_upload())
            harness.upload();
        harness.step({}, 2);
        CHECK(harness.statistics().contacts == 0);
        CHECK(reason(solver.set_radius(body, -1)).starts_with("collider 0: radius is -1"));
    }
}
