// Cloths that fall asleep: when they do, that nothing moves them then, and what wakes them.
#include "support/cloth_harness.hpp"
#include "support/cloth_meshes.hpp"
#include "support/sleep_checks.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/fabrics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace
{

using tests::Bed;
using tests::check_rests;
using tests::ClothHarness;
using tests::fastest;
using tests::k_sleep_frames;
using tests::moved;
using tests::same_bits;
using tests::sleeping;
using tests::steps_to_sleep;
using voile::engine::take;

constexpr voile::Step k_step = tests::k_sleep_step;
constexpr voile::Step k_floating{.duration = 1.f / 60, .substeps = 8, .gravity = {0, 0, 0}};

voile::GridCloth sheet(float sleep_speed, float height = 0.003f,
                       voile::Integrator integrator = voile::Integrator::verlet)
{
    return tests::sleepy_sheet(sleep_speed, height, integrator);
}

} // namespace

TEST_CASE("cloth at rest falls asleep on a plane and over a ball, and then stays to the bit")
{
    const tests::ClothMesh mesh = tests::sheet(7, 7, 0.02f);
    for (const bool ball : {false, true})
        for (const bool is_mesh : {false, true})
            for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
            {
                CAPTURE(ball);
                CAPTURE(is_mesh);
                CAPTURE(static_cast<int>(integrator));
                ClothHarness harness;
                // What hangs from the ball swings for long.
                const float speed = ball ? 0.2f : 0.01f;
                voile::ClothId cloth;
                if (is_mesh)
                {
                    voile::MeshCloth description = mesh.cloth();
                    description.transform = moved({-0.06f, 0.02f, -0.06f});
                    description.integrator = integrator;
                    description.sleep_speed = speed;
                    cloth = take(harness.solver.add_cloth(description));
                }
                else
                    cloth = take(harness.solver.add_cloth(sheet(speed, 0.02f, integrator)));
                if (ball)
                    take(harness.solver.add_collider(
                        voile::SphereCollider{.center = {0, -0.05f, 0}, .radius = 0.06f, .friction = {{0.9f, 0.8f}}}));
                take(harness.solver.add_collider(voile::PlaneCollider{.offset = ball ? -0.09f : 0}));
                harness.upload();
                const int steps = steps_to_sleep(harness, k_step, 360);
                REQUIRE(steps > static_cast<int>(k_sleep_frames)); // it fell first
                CHECK(harness.positions(cloth)[24].y < 0.0151f);   // the ball's top and the thickness
                check_rests(harness, cloth, k_step, 60);
            }
}

TEST_CASE("a cloth falls asleep after half a second below its sleep_speed, and not above")
{
    for (const bool slower : {true, false})
        for (const float duration : {1.f / 60, 1.f / 120, 0.1f})
        {
            CAPTURE(slower);
            CAPTURE(duration);
            ClothHarness harness;
            voile::GridCloth grid = sheet(0.05f, 1);
            grid.velocity = {slower ? 0.0495f : 0.0505f, 0, 0};
            const voile::ClothId cloth = take(harness.solver.add_cloth(grid));
            harness.upload();
            voile::Step step = k_floating;
            step.duration = duration;
            const int steps = steps_to_sleep(harness, step, static_cast<int>(2 / duration));
            CHECK(steps == (slower ? static_cast<int>(std::lround(0.5f / duration)) : -1));
            CHECK((fastest(harness.velocities(cloth)) == 0) == slower);
        }
}

TEST_CASE("cloth that contact moves without a velocity does not fall asleep")
{
    ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(sheet(0.1f, -1)));
    take(harness.solver.add_collider(voile::PlaneCollider{}));
    harness.upload();
    float slowest = 1;
    for (int frame = 0; frame < 60; ++frame)
    {
        harness.step(k_step);
        slowest = std::min(slowest, fastest(harness.velocities(cloth)));
        CHECK(sleeping(harness) == 0);
    }
    CHECK(slowest < 0.1f); // by its velocity alone it would
    CHECK(harness.positions(cloth)[0].y > -0.5f);
    CHECK(steps_to_sleep(harness, k_step, 180) > 0);
}

TEST_CASE(
    "no pass moves cloth that sleeps: strain limit, attachments, tethers, features, depenetration, many colliders")
{
    // So fast that all sleep after half a second, wherever they are: whatever a pass does shows.
    constexpr float k_any_speed = 10;
    const tests::ClothMesh mesh = tests::sheet(7, 7, 0.02f);
    const voile::engine::Mesh needle = voile::engine::make_sphere({0, 0, 0}, 0.012f, 6);
    for (const uint32_t colliders : {1u, 12u})
    {
        const auto integrator = colliders == 1 ? voile::Integrator::rk4 : voile::Integrator::verlet;
        CAPTURE(colliders);
        constexpr voile::Step k_step{.duration = 1.f / 60, .substeps = 3};
        ClothHarness harness;
        std::vector<voile::ClothId> sleepers;
        std::vector<voile::ClothId> awake;
        for (const bool sleeps : {true, false})
            for (uint32_t i = 0; i < 2; ++i)
            {
                const glm::vec3 position(0.3f * static_cast<float>(i), 0, sleeps ? 0 : 0.5f);
                voile::Fabric fabric = voile::cotton();
                if (i == 0)
                    fabric.stretch_stiffness = {5, 5}; // so that tethers are taut
                else
                    fabric.strain_limit = 0.01f;
                voile::ClothId cloth;
                if (i == 0)
                {
                    voile::GridCloth grid = sheet(sleeps ? k_any_speed : 0, 0, integrator);
                    grid.transform = moved(position);
                    grid.material = fabric;
                    grid.velocity = {0.3f, 0, 0};
                    cloth = take(harness.solver.add_cloth(grid));
                }
                else
                {
                    voile::MeshCloth description = mesh.cloth();
                    description.transform = moved(position);
                    description.integrator = integrator;
                    description.material = fabric;
                    description.sleep_speed = sleeps ? k_any_speed : 0;
                    cloth = take(harness.solver.add_cloth(description));
                }
                REQUIRE(harness.solver.set_attachments(
                    cloth, {voile::pin(0), voile::spring(6, 50, 0.1f), voile::max_distance(42, 0.05f)}));
                REQUIRE(harness.solver.set_tethers(cloth, voile::Tethers{}));
                (sleeps ? sleepers : awake).push_back(cloth);
                for (uint32_t c = 0; c < colliders; ++c)
                {
                    voile::MeshCollider collider = tests::collider(needle);
                    collider.transform = moved(position + glm::vec3(0.01f * static_cast<float>(c), -0.013f, 0.03f));
                    take(harness.solver.add_collider(collider));
                }
            }
        harness.upload();
        harness.step(k_step, k_sleep_frames);
        REQUIRE(sleeping(harness) == 2);
        std::vector<std::vector<glm::vec4>> before;
        for (const voile::ClothId cloth : awake)
            before.push_back(harness.positions(cloth));
        for (const voile::ClothId cloth : sleepers)
            check_rests(harness, cloth, k_step, 10);
        for (size_t i = 0; i < awake.size(); ++i)
            CHECK_FALSE(same_bits(harness.positions(awake[i]), before[i]));
        CHECK(sleeping(harness) == 2);
        // They go on from rest.
        for (const voile::ClothId cloth : sleepers)
            REQUIRE(harness.solver.wake(cloth));
        harness.step(k_step);
        CHECK(sleeping(harness) == 0);
        for (const voile::ClothId cloth : sleepers)
            CHECK(fastest(harness.velocities(cloth)) > 0.01f);
    }
}

TEST_CASE("how long a cloth slept makes no difference to how it moves then, to the bit")
{
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        std::vector<glm::vec4> ends[2];
        for (const uint32_t frames : {1u, 20u})
        {
            ClothHarness harness;
            voile::GridCloth grid = sheet(10, 0, integrator);
            voile::Fabric fabric = voile::cotton();
            fabric.strain_limit = 0.01f;
            grid.material = fabric;
            grid.pins = {0};
            const voile::ClothId cloth = take(harness.solver.add_cloth(grid));
            grid.sleep_speed = 0;
            grid.transform = moved({1, 0, 0});
            take(harness.solver.add_cloth(grid)); // the passes of the limit are recorded for it
            take(harness.solver.add_collider(voile::SphereCollider{.center = {0.02f, -0.08f, 0.02f}, .radius = 0.06f}));
            harness.upload();
            const voile::Step step{.duration = 1.f / 60, .substeps = 5};
            harness.step(step, k_sleep_frames + frames);
            REQUIRE(sleeping(harness) == 1);
            REQUIRE(harness.solver.wake(cloth));
            harness.step(step, 10);
            CHECK(sleeping(harness) == 0);
            ends[frames == 1 ? 0 : 1] = harness.positions(cloth);
        }
        CHECK(same_bits(ends[0], ends[1]));
    }
}

TEST_CASE("a hanging cloth sleeps once it is calm, and wakes when its anchor moves, not when another one does")
{
    ClothHarness harness;
    const voile::AnchorId own = take(harness.solver.add_anchor(glm::mat4(1.f)));
    const voile::AnchorId other = take(harness.solver.add_anchor(glm::mat4(1.f)));
    voile::GridCloth grid = sheet(0.03f, 0);
    voile::Fabric fabric = voile::wool();
    fabric.air_drag_normal = fabric.air_drag_tangential = 20; // it soon hangs still
    grid.material = fabric;
    const voile::ClothId cloth = take(harness.solver.add_cloth(grid));
    std::vector<voile::Attachment> pins{voile::pin(0), voile::pin(6)};
    for (voile::Attachment& pin : pins)
        pin.anchor = own;
    REQUIRE(harness.solver.set_attachments(cloth, pins));
    harness.upload();
    const int steps = steps_to_sleep(harness, k_step, 1200);
    REQUIRE(steps > 30);
    float height = 0;
    check_rests(harness, cloth, k_step, 30,
                [&] {
                    REQUIRE(harness.solver.move_anchor(other, moved({0, height += 0.01f, 0})));
                });
    REQUIRE(harness.solver.move_anchor(own, moved({0, 0.001f, 0})));
    harness.step(k_step);
    CHECK(sleeping(harness) == 0);
    harness.step(k_step, 5);
    CHECK(harness.positions(cloth)[0].y == doctest::Approx(0.001f));
    CHECK(fastest(harness.velocities(cloth)) > 0);
}

namespace
{

// What comes down on a sheet around the origin, its lowest point at `start` (m) at first.
enum Descending
{
    k_sphere,
    k_mesh,
    k_deforming,
    k_turning, // one end of a long box
    k_descending
};

class Descent
{
public:
    Descent(voile::Solver& solver, int kind, float start) : solver_(solver), kind_(kind)
    {
        const glm::vec3 center(0.013f, start + 0.05f, 0.007f); // not above a vertex
        if (kind == k_sphere)
            collider_ = take(solver.add_collider(voile::SphereCollider{.center = center, .radius = 0.05f}));
        else if (kind == k_turning)
            collider_ = take(
                solver.add_collider(voile::BoxCollider{.min = {0, start, -0.03f}, .max = {2, start + 0.02f, 0.03f}}));
        else
        {
            voile::MeshCollider description = kind == k_mesh ? tests::collider(ball_) : tests::deforming(ball_);
            description.transform = moved(center);
            collider_ = take(solver.add_collider(description));
        }
    }

    // `down`: m, in all.
    void move(float down)
    {
        const glm::vec3 way(0, -down, 0);
        if (kind_ == k_deforming)
            REQUIRE(solver_.deform_collider(collider_, tests::transformed(ball_.positions, moved(way))));
        else if (kind_ == k_turning)
            REQUIRE(solver_.move_collider(collider_, moved({2, 0, 0}) *
                                                         glm::rotate(glm::mat4(1.f), 0.5f * down, glm::vec3(0, 0, 1)) *
                                                         moved({-2, 0, 0})));
        else
            REQUIRE(solver_.move_collider(collider_, moved(way)));
    }

private:
    voile::Solver& solver_;
    int kind_;
    voile::engine::Mesh ball_ = voile::engine::make_sphere({0, 0, 0}, 0.05f, 8);
    voile::ColliderId collider_{};
};

struct Struck
{
    std::vector<glm::vec4> at_contact;
    std::vector<glm::vec4> at_end;
    int woken = 0; // the first frame in which the sheet does not sleep
};

// The collider touches in the third of six frames. `woken`: the frame in which the host wakes the sheet, 0: it does
// not.
Struck strike(const voile::GridCloth& grid, int kind, float speed, int woken)
{
    ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(grid));
    Descent descent(harness.solver, kind, 0.004f + 2.5f * speed / 60);
    harness.upload();
    voile::Step calm = k_floating;
    calm.substeps = 2;
    harness.step(calm, k_sleep_frames);
    CHECK(sleeping(harness) == (grid.sleep_speed > 0 ? 1 : 0));
    Struck result;
    for (int frame = 1; frame <= 6; ++frame)
    {
        descent.move(speed * static_cast<float>(frame) / 60);
        if (frame == woken)
            REQUIRE(harness.solver.wake(cloth));
        harness.step(k_floating);
        const voile::Statistics statistics = harness.statistics();
        CHECK(statistics.penetrating_vertices == 0);
        if (statistics.sleeping_cloths == 0 && result.woken == 0)
            result.woken = frame;
        if (frame == 3)
            result.at_contact = harness.positions(cloth);
    }
    CHECK(sleeping(harness) == 0);
    if (kind != k_turning)
        CHECK(fastest(harness.velocities(cloth)) > 0.5f * speed);
    result.at_end = harness.positions(cloth);
    return result;
}

} // namespace

TEST_CASE("a collider that comes near wakes cloth, which then moves as if it had never slept")
{
    for (int kind = 0; kind < k_descending; ++kind)
        for (const float speed : {0.1f, 50.f})
        {
            const auto integrator = kind == k_sphere ? voile::Integrator::rk4 : voile::Integrator::verlet;
            CAPTURE(kind);
            CAPTURE(speed);
            const Struck slept = strike(sheet(0.01f, 0, integrator), kind, speed, 0);
            const Struck woken = strike(sheet(0.01f, 0, integrator), kind, speed, slept.woken);
            CHECK(slept.woken >= 1);
            CHECK(slept.woken <= 3);
            CHECK(same_bits(slept.at_end, woken.at_end));
            // Without gravity a sheet that cannot sleep is in the same state, but for rounding.
            const Struck awake = strike(sheet(0, 0, integrator), kind, speed, 0);
            glm::dvec3 difference(0); // of the means: thrown cloth folds in another way
            for (size_t i = 0; i < awake.at_contact.size(); ++i)
                difference += glm::dvec3(awake.at_contact[i]) - glm::dvec3(slept.at_contact[i]);
            const double mean = glm::length(difference) / static_cast<double>(awake.at_contact.size());
            CHECK(mean < (kind == k_mesh && speed > 1 ? 6e-3 : 8e-6)); // 1.7e-6 on an H100, 2e-8 on lavapipe
        }
}

TEST_CASE("a collider that moves far away, or of other layers, does not wake cloth")
{
    Bed bed;
    voile::Solver& solver = bed.harness.solver;
    const voile::engine::Mesh mesh = voile::engine::make_sphere({0, 0, 0}, 0.05f, 8);
    const voile::ColliderId ball =
        take(solver.add_collider(voile::SphereCollider{.center = {0.3f, 0.05f, 0}, .radius = 0.1f}));
    voile::MeshCollider deforming = tests::deforming(mesh);
    deforming.transform = moved({-0.3f, 0.1f, 0});
    const voile::ColliderId soft = take(solver.add_collider(deforming));
    const voile::ColliderId other =
        take(solver.add_collider(voile::SphereCollider{.center = {0, 0.06f, 0}, .radius = 0.05f, .layers = 2}));
    bed.harness.upload();
    bed.harness.step(k_step);
    CHECK(sleeping(bed.harness) == 0); // new colliders
    REQUIRE(steps_to_sleep(bed.harness, k_step, 40) > 0);
    float time = 0;
    check_rests(bed.harness, bed.cloth, k_step, 30,
                [&]
                {
                    time += 1.f / 60;
                    REQUIRE(solver.move_collider(ball, moved({0, time, time})));
                    REQUIRE(solver.deform_collider(soft, tests::transformed(mesh.positions, moved({-time, 0, 0}))));
                    REQUIRE(solver.move_collider(other, moved({0, -time, 0})));
                });
}

TEST_CASE("cloth on a collider that moves more slowly than its sleep_speed stays awake and rides on it")
{
    ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(sheet(0.05f, 0.005f)));
    const voile::ColliderId table =
        take(harness.solver.add_collider(voile::BoxCollider{.min = {-0.5f, -0.1f, -0.5f}, .max = {0.5f, 0, 0.5f}}));
    harness.upload();
    for (int frame = 1; frame <= 120; ++frame)
    {
        REQUIRE(harness.solver.move_collider(table, moved({0, 0.02f * static_cast<float>(frame) / 60, 0})));
        harness.step(k_step);
        CHECK(sleeping(harness) == 0);
    }
    CHECK(harness.positions(cloth)[24].y > 0.04f);
    CHECK(steps_to_sleep(harness, k_step, 60) > 0);
}
