// Cloth that collides with itself moves with what carries it as freely as at rest, whatever the speed
// (moving_frame.glsl).
#include "support/carried_cloth.hpp"

#include "voile/engine/assets/shapes.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>

namespace
{

using tests::airless_pair_sheet;
using tests::at;
using tests::budget_in_turn;
using tests::Capes;
using tests::k_frame;
using tests::PairHarness;
using tests::position_of;
using tests::step_of;
using voile::engine::take;

// Moves a floor to a position along x.
using MoveFloor = std::function<void(PairHarness&, float)>;

MoveFloor move_rigidly(voile::ColliderId id)
{
    return [id](PairHarness& moved, float along) { take(moved.solver.move_collider(id, at({along, 0, 0}))); };
}

MoveFloor box_floor(PairHarness& harness)
{
    const auto id =
        take(harness.solver.add_collider(voile::BoxCollider{.min = {-0.5f, -0.1f, -0.5f}, .max = {0.5f, 0, 0.5f}}));
    return move_rigidly(id);
}

MoveFloor deforming_floor(PairHarness& harness)
{
    const voile::engine::Mesh box = voile::engine::make_box({-0.5f, -0.1f, -0.5f}, {0.5f, 0, 0.5f});
    const auto id = take(harness.solver.add_collider(tests::deforming(box)));
    return [id, box](PairHarness& moved, float along) {
        take(moved.solver.deform_collider(id, tests::transformed(box.positions, at({along, 0, 0}))));
    };
}

MoveFloor floor_over_ground(PairHarness& harness)
{
    take(harness.solver.add_collider(voile::PlaneCollider{.normal = {0, 1, 0}, .offset = -0.02f}));
    const auto id =
        take(harness.solver.add_collider(voile::BoxCollider{.min = {-0.5f, -0.02f, -0.5f}, .max = {0.5f, 0, 0.5f}}));
    return move_rigidly(id);
}

uint64_t forced(PairHarness& harness)
{
    return harness.statistics().forced_pairs;
}

} // namespace

TEST_CASE("layers on a floor that moves at 2 to 30 m/s do not slip, with all substeps and with 8")
{
    uint32_t run = 0;
    struct Case
    {
        const char* name;
        MoveFloor (*add)(PairHarness&);
        float speed; // m/s
    };
    for (const Case& test :
         {Case{"box", &box_floor, 30}, Case{"mesh that deforms", &deforming_floor, 2},
          Case{"box over ground at rest", &floor_over_ground, 30}, Case{"mesh that deforms", &deforming_floor, 30}})
    {
        const uint32_t substeps = budget_in_turn(run++);
        CAPTURE(test.name);
        CAPTURE(test.speed);
        CAPTURE(substeps);
        PairHarness harness;
        const MoveFloor move = test.add(harness);
        tests::add_layers(harness, airless_pair_sheet(9, 0.02f, {test.speed, 0, 0}), {0.013f, 0, 0.007f});
        harness.upload();
        constexpr int k_frames = 10;
        for (int frame = 1; frame <= k_frames; ++frame)
        {
            move(harness, test.speed * k_frame * static_cast<float>(frame));
            harness.step(step_of(substeps));
        }
        const double moved = static_cast<double>(test.speed * k_frame * k_frames);
        for (const voile::ClothId cloth : harness.cloths)
            CHECK(std::abs(position_of(harness, cloth) - moved - 0.013) < 2e-4);
        CHECK(harness.intersections() == 0);
    }
}

TEST_CASE("capes on anchors that move at 8 to 40 m/s stay at rest relative to them")
{
    struct Case
    {
        float spacing; // m
        float speed;   // m/s
        uint32_t layers;
        voile::Integrator integrator;
    };
    constexpr auto k_verlet = voile::Integrator::verlet;
    for (const Case& test :
         {Case{0.01f, 8, 1, k_verlet}, Case{0.01f, 15, 1, k_verlet}, Case{0.01f, 15, 1, voile::Integrator::rk4},
          Case{0.025f, 40, 1, k_verlet}, Case{0.025f, 20, 2, k_verlet}})
    {
        CAPTURE(test.spacing);
        CAPTURE(test.speed);
        PairHarness harness;
        voile::GridCloth grid = airless_pair_sheet(9, test.spacing, {test.speed, 0, 0});
        grid.integrator = test.integrator;
        Capes capes(harness, test.layers, grid, {0, 0, 0});
        harness.upload();
        for (int frame = 1; frame <= 8; ++frame)
        {
            capes.move(test.speed * k_frame * static_cast<float>(frame));
            harness.step(step_of(tests::k_all));
        }
        for (const voile::ClothId cloth : harness.cloths)
            CHECK(tests::fastest_beside(harness, cloth, test.speed) < 0.03f);
        CHECK(harness.intersections() == 0);
        CHECK(forced(harness) == 0);
    }
}

// Without self-collision the same capes lag by as much, and stretch by up to 0.40.
TEST_CASE("capes follow anchors that accelerate, in 8 and 16 substeps a frame")
{
    struct Case
    {
        float spacing; // m
        float speed;   // m/s, reached in half a second
        uint32_t substeps;
        uint32_t layers;
    };
    for (const Case& test :
         {Case{0.01f, 2, 8, 1}, Case{0.01f, 6, 16, 1}, Case{0.025f, 6, 8, 1}, Case{0.025f, 3, 16, 2}})
    {
        CAPTURE(test.spacing);
        CAPTURE(test.speed);
        PairHarness harness;
        Capes capes(harness, test.layers, airless_pair_sheet(9, test.spacing, {0, 0, 0}), {0, 0, 0});
        harness.upload();
        float along = 0;
        float stretch = 0;
        for (int frame = 1; frame <= 60; ++frame)
        {
            along += std::min(1.f, static_cast<float>(frame) / 30) * test.speed * k_frame;
            capes.move(along);
            harness.step(step_of(test.substeps));
            stretch = std::max(stretch, harness.statistics().max_stretch);
        }
        for (const voile::ClothId cloth : harness.cloths)
            CHECK(std::abs(position_of(harness, cloth) - static_cast<double>(along)) < 0.01);
        CHECK(stretch < 0.5f);
        CHECK(harness.intersections() == 0);
        CHECK(forced(harness) == 0);
    }
}

TEST_CASE("two capes that are carried past each other at 10 m/s have frames of their own")
{
    constexpr float k_speed = 10;
    PairHarness harness;
    Capes right(harness, 1, airless_pair_sheet(9, 0.02f, {k_speed, 0, 0}), {-1, 0, 0});
    Capes left(harness, 1, airless_pair_sheet(9, 0.02f, {-k_speed, 0, 0}), {1, 0, 0.05f});
    harness.upload();
    for (int frame = 1; frame <= 13; ++frame)
    {
        const float along = k_speed * k_frame * static_cast<float>(frame);
        right.move(along);
        left.move(-along);
        harness.step(step_of(8));
    }
    for (size_t side = 0; side < 2; ++side)
    {
        const float direction = side == 0 ? 1.f : -1.f;
        const double position = direction * (k_speed * k_frame * 13 - 1);
        CHECK(std::abs(position_of(harness, harness.cloths[side]) - position) < 1e-3);
    }
    CHECK(harness.intersections() == 0);
    CHECK(forced(harness) == 0);
}

// Both slide on a floor, 0.14 m apart.
TEST_CASE("a velocity that is not a number does not move the frame of cloth near it")
{
    const auto slide = [](bool finite)
    {
        PairHarness harness;
        take(harness.solver.add_collider(voile::PlaneCollider{.normal = {0, 1, 0}, .offset = 0}));
        for (const float along : {0.f, 0.3f})
        {
            voile::GridCloth grid = airless_pair_sheet(9, 0.02f, {1, 0, 0});
            grid.transform = at({along, 1.05f * tests::fabric_of(grid).thickness, 0});
            harness.add(grid);
        }
        harness.upload();
        harness.step(step_of(tests::k_all), 3);
        std::vector<glm::vec4> velocities = harness.velocities(harness.cloths[1]);
        if (!finite)
            velocities[40].x = std::numeric_limits<float>::quiet_NaN();
        const voile::VertexStreams streams = harness.solver.vertices(harness.cloths[1]);
        harness.write(streams.velocities, streams.offset, velocities);
        harness.step(step_of(tests::k_all), 5);
        return position_of(harness, harness.cloths[0]);
    };
    CHECK(std::abs(slide(false) - slide(true)) < 1e-4);
}

TEST_CASE("a vertex of a mesh without triangles, which stays where it is, does not hold the rest, and forces nothing")
{
    for (const uint32_t substeps : {16u, tests::k_all})
    {
        CAPTURE(substeps);
        PairHarness harness;
        voile::engine::Mesh mesh = tests::quads(
            8, 8, [](float column, float row) { return glm::vec3(0.025f * column - 0.1f, -0.025f * row, 0); });
        mesh.positions.emplace_back(0, -0.3f, 0);
        voile::MeshCloth cape{.positions = mesh.positions, .triangles = mesh.triangles};
        cape.velocity = {8, 0, 0};
        cape.material = tests::fabric_of(airless_pair_sheet(9, 0.025f, {0, 0, 0}));
        cape.integrator = voile::Integrator::verlet;
        cape.self_collision = true;
        const voile::ClothId id = harness.add(cape);
        const voile::AnchorId anchor = take(harness.solver.add_anchor(glm::mat4(1)));
        std::vector<voile::Attachment> pins;
        for (uint32_t column = 0; column <= 8; ++column)
            pins.push_back(voile::pin(column, anchor));
        take(harness.solver.set_attachments(id, pins));
        harness.upload();
        for (int frame = 1; frame <= 12; ++frame)
        {
            take(harness.solver.move_anchor(anchor, at({8 * k_frame * static_cast<float>(frame), 0, 0})));
            harness.step(step_of(substeps));
            CHECK(forced(harness) == 0);
        }
        CHECK(harness.statistics().max_stretch < 0.1f); // measured: 0.06 in 16 substeps, with or without the vertex
    }
}
