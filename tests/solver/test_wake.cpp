// What the host does to cloths that sleep: changes that wake them, snapshots, and cloths beside them.
#include "support/cloth_meshes.hpp"
#include "support/sleep_checks.hpp"

#include "voile/engine/assets/shapes.hpp"
#include "voile/fabrics.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace
{

using tests::Bed;
using tests::check_rests;
using tests::ClothHarness;
using tests::k_sleep_frames;
using tests::moved;
using tests::reason;
using tests::same_bits;
using tests::sleeping;
using tests::sleepy_sheet;
using tests::steps_to_sleep;
using voile::engine::take;

constexpr voile::Step k_step = tests::k_sleep_step;

voile::SolverOptions reusing()
{
    voile::SolverOptions options;
    options.command_reuse = {.queue_family = tests::device().queue_family(), .steps_in_flight = 1};
    return options;
}

// A sheet that sleeps as it swings from a pin in the air, so that it moves in the step in which it wakes; ground and a
// ball far away.
struct Room : Bed
{
    explicit Room() : Bed(description())
    {
        anchor = take(harness.solver.add_anchor(glm::mat4(1.f)));
        ball = take(harness.solver.add_collider(
            voile::SphereCollider{.center = {2, 1, 0}, .radius = 0.1f, .friction = {{0.5f, 0.4f}}}));
        other = take(harness.solver.add_cloth(sleepy_sheet(0, 3)));
        REQUIRE(harness.solver.set_attachments(cloth, {voile::pin(0, anchor)}));
        harness.upload();
        REQUIRE(steps_to_sleep(harness, k_step, 60) > 0);
    }

    static voile::GridCloth description()
    {
        voile::GridCloth grid = sleepy_sheet(10, 3);
        grid.material = voile::cotton();
        return grid;
    }

    void upload_collider(const voile::Collider& collider)
    {
        take(harness.solver.add_collider(collider));
        harness.upload();
    }

    voile::AnchorId anchor{};
    voile::ColliderId ball{};
    voile::ClothId other{};
    voile::Step step = k_step;
};

struct Reason
{
    const char* name;
    std::function<void(Room&)> change;
    bool wakes = true;
};

std::vector<Reason> reasons()
{
    using voile::Solver;
    const auto solver = [](const std::function<void(Solver&, Room&)>& change)
    { return [change](Room& room) { change(room.harness.solver, room); }; };
    return {
        {"nothing", [](Room&) {}, false},
        {"another cloth's material", solver([](Solver& s, Room& r) { take(s.set_material(r.other, voile::silk())); }),
         false},
        {"another cloth's reset", solver([](Solver& s, Room& r) { take(s.reset(r.other)); }), false},
        {"another cloth is removed", solver([](Solver& s, Room& r) { take(s.remove(r.other)); }), false},
        {"another cloth is added",
         [](Room& r)
         {
             take(r.harness.solver.add_cloth(sleepy_sheet(0, 5)));
             r.harness.upload();
         },
         false},
        {"another anchor",
         solver(
             [](Solver& s, Room&) {
                 take(s.add_anchor(moved({1, 0, 0})));
             }),
         false},
        {"time and gusts without wind",
         [](Room& r)
         {
             r.step.time = 5;
             r.step.duration = 1.f / 50;
         },
         false},
        {"wake", solver([](Solver& s, Room& r) { take(s.wake(r.cloth)); })},
        {"material", solver([](Solver& s, Room& r) { take(s.set_material(r.cloth, voile::silk())); })},
        {"sleep_speed", solver([](Solver& s, Room& r) { take(s.set_sleep_speed(r.cloth, 0.02f)); })},
        {"no sleep_speed", solver([](Solver& s, Room& r) { take(s.set_sleep_speed(r.cloth, 0)); })},
        {"attachments", solver([](Solver& s, Room& r) { take(s.set_attachments(r.cloth, {})); })},
        {"tethers", solver([](Solver& s, Room& r) { take(s.set_tethers(r.cloth, voile::Tethers{})); })},
        {"reset", solver([](Solver& s, Room& r) { take(s.reset(r.cloth)); })},
        {"teleport", solver(
                         [](Solver& s, Room& r) {
                             take(s.teleport(r.cloth, moved({0, 0.1f, 0})));
                         })},
        {"velocity", solver(
                         [](Solver& s, Room& r) {
                             take(s.set_velocity(r.cloth, {0, 1, 0}));
                         })},
        {"layers", solver([](Solver& s, Room& r) { take(s.set_layers(r.cloth, 3)); })},
        {"disabled and enabled",
         [](Room& r)
         {
             take(r.harness.solver.set_enabled(r.cloth, false));
             r.harness.step(r.step, 2);
             CHECK(sleeping(r.harness) == 0);
             take(r.harness.solver.set_enabled(r.cloth, true));
         }},
        {"anchor moves", solver(
                             [](Solver& s, Room& r) {
                                 take(s.move_anchor(r.anchor, moved({0, 1e-4f, 0})));
                             })},
        {"anchor is removed", solver([](Solver& s, Room& r) { take(s.remove(r.anchor)); })},
        {"gravity",
         [](Room& r) {
             r.step.gravity = {0, -9.8f, 0};
         }},
        {"wind",
         [](Room& r) {
             r.step.wind = {0, 0, 0.1f};
         }},
        {"gusts", [](Room& r) { r.step.gust = 0.1f; }},
        {"air", [](Room& r) { r.step.air_density = 1; }},
        {"collider is added",
         [](Room& r) {
             r.upload_collider(voile::SphereCollider{.center = {3, 3, 0}, .radius = 0.1f});
         }},
        {"collider of other layers is added",
         [](Room& r) {
             r.upload_collider(voile::SphereCollider{.center = {3, 3, 0}, .radius = 0.1f, .layers = 2});
         },
         false},
        {"collider is removed", solver([](Solver& s, Room& r) { take(s.remove(r.ground)); })},
        {"collider is disabled", solver([](Solver& s, Room& r) { take(s.set_enabled(r.ground, false)); })},
        {"collider's friction", solver(
                                    [](Solver& s, Room& r) {
                                        take(s.set_friction(r.ground, {{0.1f, 0.1f}}));
                                    })},
        {"collider's layers", solver([](Solver& s, Room& r) { take(s.set_layers(r.ground, 2)); })},
        {"collider's radius", solver([](Solver& s, Room& r) { take(s.set_radius(r.ball, 0.2f)); })},
    };
}

} // namespace

TEST_CASE("cloth that sleeps wakes for each of the host's reasons, and for no other")
{
    for (const Reason& reason : reasons())
    {
        CAPTURE(reason.name);
        Room room;
        const auto before = room.harness.positions(room.cloth);
        reason.change(room);
        room.harness.step(room.step);
        CHECK(sleeping(room.harness) == (reason.wakes ? 0 : 1));
        CHECK(same_bits(room.harness.positions(room.cloth), before) != reason.wakes);
    }
}

TEST_CASE("a collider that is enabled wakes cloth, and ground that is removed lets it fall")
{
    Bed bed;
    take(bed.harness.solver.set_enabled(bed.ground, false));
    bed.harness.step(k_step, 10);
    CHECK(bed.harness.positions(bed.cloth)[0].y < -0.05f);
    take(bed.harness.solver.teleport(bed.cloth, moved({0, 1, 0})));
    bed.harness.step({.duration = 1.f / 60, .substeps = 8, .gravity = {0, 0, 0}});
    take(bed.harness.solver.set_velocity(bed.cloth, {0, 0, 0}));
    voile::Step floating = k_step;
    floating.gravity = {0, 0, 0};
    REQUIRE(steps_to_sleep(bed.harness, floating, 60) > 0);
    take(bed.harness.solver.set_enabled(bed.ground, true));
    bed.harness.step(floating);
    CHECK(sleeping(bed.harness) == 0);
}

TEST_CASE("gusts keep cloth with drag awake, not cloth without")
{
    for (const float drag : {0.f, 1.f})
    {
        ClothHarness harness;
        voile::GridCloth grid = sleepy_sheet(10, 0);
        tests::fabric_of(grid).air_drag_normal = drag;
        take(harness.solver.add_cloth(grid));
        harness.upload();
        voile::Step step = k_step;
        step.gravity = {0, 0, 0};
        step.wind = {0, 0.01f, 0};
        step.gust = 0.5f;
        CHECK((steps_to_sleep(harness, step, 60) > 0) == (drag == 0));
    }
}

TEST_CASE("a cloth that is reset as it sleeps falls again as at first, to the bit")
{
    for (const auto integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
    {
        ClothHarness harness;
        const voile::ClothId cloth = take(harness.solver.add_cloth(sleepy_sheet(0.01f, 0.02f, integrator)));
        take(harness.solver.add_collider(voile::PlaneCollider{}));
        harness.upload();
        std::vector<std::vector<glm::vec4>> fall;
        for (int frame = 0; frame < 40; ++frame)
        {
            harness.step(k_step);
            fall.push_back(harness.positions(cloth));
        }
        REQUIRE(sleeping(harness) == 1);
        take(harness.solver.reset(cloth));
        for (const auto& before : fall)
        {
            harness.step(k_step);
            CHECK(same_bits(harness.positions(cloth), before));
        }
        CHECK(sleeping(harness) == 1);
    }
}

TEST_CASE("a snapshot of cloth that sleeps: it sleeps on if nothing changed, and wakes if anything did")
{
    for (const std::string change : {"none", "gravity", "ground", "bytes", "moved ball"})
    {
        CAPTURE(change);
        Bed bed;
        ClothHarness& harness = bed.harness;
        voile::Solver& solver = harness.solver;
        const voile::ColliderId ball =
            take(solver.add_collider(voile::SphereCollider{.center = {2, 1, 0}, .radius = 0.1f}));
        harness.upload();
        REQUIRE(steps_to_sleep(harness, k_step, 60) > 0);
        const auto asleep = harness.positions(bed.cloth);
        voile::Snapshot snapshot = take(solver.create_snapshot());
        harness.run([&](VkCommandBuffer cmd) { take(solver.record_save(cmd, snapshot)); });
        harness.step(k_step, 3);
        CHECK(sleeping(harness) == 1); // saving wakes nothing
        voile::Step step = k_step;
        if (change == "gravity")
            step.gravity = {0, -5, 0};
        if (change == "ground")
            take(solver.remove(bed.ground));
        if (change == "bytes")
            take(snapshot.assign(std::vector(snapshot.bytes().begin(), snapshot.bytes().end())));
        if (change == "moved ball")
            take(solver.move_collider(ball, moved({0, 0.1f, 0})));
        harness.step(step);
        harness.run([&](VkCommandBuffer cmd) { take(solver.record_restore(cmd, snapshot)); });
        CHECK(same_bits(harness.positions(bed.cloth), asleep));
        harness.step(step);
        CHECK(sleeping(harness) == (change == "none" ? 1 : 0));
        if (change == "none")
            check_rests(harness, bed.cloth, step, 10);
    }
}

TEST_CASE("a snapshot of cloth that is almost calm continues to the bit")
{
    ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(sleepy_sheet(10, 1)));
    harness.upload();
    voile::Step step = k_step;
    step.gravity = {0, -1, 0};
    harness.step(step, k_sleep_frames - 10);
    voile::Snapshot snapshot = take(harness.solver.create_snapshot());
    harness.run([&](VkCommandBuffer cmd) { take(harness.solver.record_save(cmd, snapshot)); });
    std::vector<glm::vec4> ends[2];
    for (std::vector<glm::vec4>& end : ends)
    {
        harness.step(step, 9);
        CHECK(sleeping(harness) == 0);
        harness.step(step);
        CHECK(sleeping(harness) == 1);
        end = harness.positions(cloth);
        harness.run([&](VkCommandBuffer cmd) { take(harness.solver.record_restore(cmd, snapshot)); });
    }
    CHECK(same_bits(ends[0], ends[1]));
}

TEST_CASE("a cloth moves beside fifty that sleep as it does alone, to the bit")
{
    std::vector<glm::vec4> ends[2];
    for (const bool alone : {true, false})
    {
        ClothHarness harness(alone ? voile::SolverOptions{} : reusing());
        const voile::ClothId mover = take(harness.solver.add_cloth(sleepy_sheet(0, 0.3f)));
        take(harness.solver.add_collider(voile::PlaneCollider{.layers = 2}));
        take(harness.solver.add_collider(voile::SphereCollider{.center = {0, 0.1f, 0}, .radius = 0.05f}));
        for (int i = 0; i < 50 && !alone; ++i)
        {
            const auto integrator = i % 2 == 0 ? voile::Integrator::verlet : voile::Integrator::rk4;
            voile::GridCloth grid = sleepy_sheet(0.01f, 0.003f, integrator);
            grid.transform = moved({0.2f * static_cast<float>(i % 10), 0.003f, 0.2f * static_cast<float>(i / 10)});
            grid.layers = 2;
            take(harness.solver.add_cloth(grid));
        }
        harness.upload();
        harness.step(k_step, 40);
        CHECK(sleeping(harness) == (alone ? 0 : 50));
        REQUIRE(harness.solver.set_velocity(mover, {0, 2, 0}));
        harness.step(k_step, 40);
        CHECK(sleeping(harness) == (alone ? 0 : 50));
        ends[alone ? 0 : 1] = harness.positions(mover);
    }
    CHECK(same_bits(ends[0], ends[1]));
}

TEST_CASE("commands that are used again are used as cloths fall asleep, sleep and wake")
{
    std::vector<glm::vec4> ends[2];
    for (const bool reuses : {false, true})
    {
        ClothHarness harness(reuses ? reusing() : voile::SolverOptions{});
        const voile::ClothId cloth = take(harness.solver.add_cloth(sleepy_sheet(0.01f, 0.02f)));
        take(harness.solver.add_collider(voile::PlaneCollider{}));
        const voile::ColliderId ball =
            take(harness.solver.add_collider(voile::SphereCollider{.center = {0, 0.3f, 0}, .radius = 0.05f}));
        take(harness.solver.move_collider(ball, moved({0, 0.01f, 0})));
        harness.upload();
        harness.step(k_step, 6);
        uint32_t used = 0;
        for (int frame = 0; frame < 60; ++frame)
        {
            if (frame >= 40)
                take(harness.solver.move_collider(ball, moved({0, -0.02f * static_cast<float>(frame - 39), 0})));
            harness.step(k_step);
            used += harness.solver.record_report().reused ? 1 : 0;
            if (frame == 39)
                CHECK(sleeping(harness) == 1);
        }
        CHECK(sleeping(harness) == 0);
        if (reuses)
            CHECK(used == 60);
        ends[reuses ? 1 : 0] = harness.positions(cloth);
    }
    CHECK(same_bits(ends[0], ends[1]));
}

TEST_CASE("a sleep_speed out of range is an error, and nothing changes")
{
    ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(sleepy_sheet(10)));
    const tests::ClothMesh mesh = tests::sheet(4, 4, 0.02f);
    for (const auto& [speed, shown] : {std::pair(-0.1f, "-0.1"), std::pair(10.5f, "10.5"),
                                       std::pair(std::numeric_limits<float>::quiet_NaN(), "nan")})
    {
        const std::string message = std::string("cloth \"cloth\": sleep_speed is ") + shown + " m/s, must be 0 to 10";
        CHECK(reason(harness.solver.add_cloth(sleepy_sheet(speed))) == message);
        voile::MeshCloth description = mesh.cloth();
        description.sleep_speed = speed;
        CHECK(reason(harness.solver.add_cloth(description)) == message);
        CHECK(reason(harness.solver.set_sleep_speed(cloth, speed)) == message);
    }
    take(harness.solver.remove(cloth));
    CHECK_FALSE(harness.solver.set_sleep_speed(cloth, 1).has_value());
    CHECK_FALSE(harness.solver.wake(cloth).has_value());
}

// The support jumps away in the last of the steps after which the cloth would have slept.
TEST_CASE("cloth that loses its support just before it would sleep falls")
{
    tests::ClothHarness harness;
    const voile::ClothId cloth = take(harness.solver.add_cloth(tests::sleepy_sheet(0.4f)));
    const voile::ColliderId ground = take(harness.solver.add_collider(voile::PlaneCollider{}));
    harness.upload();
    harness.step(tests::k_sleep_step, tests::k_sleep_frames - 1);
    REQUIRE(tests::sleeping(harness) == 0);
    take(harness.solver.move_collider(ground, tests::moved({0, -5, 0})));
    harness.step(tests::k_sleep_step, 15);
    CHECK(tests::sleeping(harness) == 0);
    CHECK(harness.positions(cloth)[24].y < -0.2f); // 0.31 m in free fall
}
