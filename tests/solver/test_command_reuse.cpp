// Commands that are used again (SolverOptions::command_reuse): equal results, truthful reports, and errors.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/counted_commands.hpp"
#include "support/gate.hpp"
#include "support/recorded_dispatches.hpp"

#include "solver/step_commands.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/fabrics.hpp"

#include <string>
#include <vector>

namespace
{

using tests::ClothHarness;
using tests::moved;
using voile::engine::take;

constexpr float k_frame = 1.f / 60; // s

voile::SolverOptions reusing(voile::SolverOptions options = {})
{
    options.command_reuse = {.queue_family = tests::device().queue_family(), .steps_in_flight = 1};
    return options;
}

voile::GridCloth sheet(float height, voile::Integrator integrator)
{
    voile::GridCloth grid = tests::flat_sheet(12, 0.5f, height);
    grid.material = voile::wool();
    grid.integrator = integrator;
    return grid;
}

// What happens to a solver. All of its cloths are compared.
class Scene
{
public:
    explicit Scene(const voile::SolverOptions& options) : harness(options) {}
    virtual ~Scene() = default;
    // Before a frame's step.
    virtual void change(uint32_t frame) = 0;

    voile::Step step(uint32_t frame)
    {
        voile::Step step = next;
        step.duration = k_frame;
        step.time = static_cast<double>(frame) / 60;
        step.wind = {1, 0.1f * static_cast<float>(frame % 7), 2};
        step.gravity.x = 0.05f * static_cast<float>(frame % 5);
        return step;
    }

    ClothHarness harness;
    std::vector<voile::ClothId> cloths;
    voile::Step next{.substeps = 6, .gust = 0.3f};

protected:
    void add(const voile::GridCloth& grid) { cloths.push_back(take(harness.solver.add_cloth(grid))); }
    voile::Solver& solver() { return harness.solver; }
};

// Two integrators over a box and a ball that move: features, depenetration, gusts, two levels of substeps.
class MovingColliders : public Scene
{
public:
    explicit MovingColliders(const voile::SolverOptions& options) : Scene(options)
    {
        next = {.max_substeps = 12, .gust = 0.3f};
        add(sheet(0.25f, voile::Integrator::verlet));
        voile::GridCloth stiff = sheet(0.26f, voile::Integrator::rk4);
        stiff.transform = moved({0.6f, 0.26f, 0});
        add(stiff);
        const voile::engine::Mesh box = voile::engine::make_box({-0.1f, 0.1f, -0.1f}, {0.1f, 0.22f, 0.1f});
        box_ = take(solver().add_collider(tests::collider(box)));
        ball_ = take(solver().add_collider(voile::SphereCollider{.center = {0.6f, 0.15f, 0}, .radius = 0.1f}));
        harness.upload();
    }

    void change(uint32_t frame) override
    {
        const float time = static_cast<float>(frame) * k_frame;
        take(solver().move_collider(box_, moved({0, 0.5f * time, 0.1f * time})));
        if (frame > 4)
            take(solver().move_collider(ball_, moved({0, 0.6f * time, 0})));
    }

private:
    voile::ColliderId box_;
    voile::ColliderId ball_;
};

// A box that deforms, beside more colliders than are traversed without lists of near ones.
class Deforming : public Scene
{
public:
    explicit Deforming(const voile::SolverOptions& options) : Scene(options)
    {
        add(sheet(0.23f, voile::Integrator::verlet));
        box_ = voile::engine::make_box({-0.1f, 0.1f, -0.1f}, {0.1f, 0.22f, 0.1f});
        id_ = take(solver().add_collider(tests::deforming(box_)));
        for (int i = 0; i < 9; ++i)
            (void)take(solver().add_collider(
                voile::SphereCollider{.center = {0.05f * static_cast<float>(i) - 0.2f, 0.05f, 0.2f}, .radius = 0.05f}));
        harness.upload();
    }

    void change(uint32_t frame) override
    {
        const float time = static_cast<float>(frame) * k_frame;
        glm::mat4 shape = glm::scale(moved({0, 0.3f * time, 0}), glm::vec3(1 + time, 1, 1 - time));
        shape[1].x = 0.5f * time;
        if (frame % 8 != 7) // it rests now and then
            take(solver().deform_collider(id_, tests::transformed(box_.positions, shape)));
    }

private:
    voile::engine::Mesh box_;
    voile::ColliderId id_;
};

// Two sheets that collide with themselves and each other, the upper one on an anchor, the lower one softened.
class Pairs : public Scene
{
public:
    explicit Pairs(const voile::SolverOptions& options) : Scene(options)
    {
        next = {.max_substeps = 10, .gust = 0.3f};
        voile::GridCloth lower = sheet(0.006f, voile::Integrator::verlet);
        lower.self_collision = true;
        add(lower);
        voile::GridCloth upper = sheet(0.02f, voile::Integrator::verlet);
        upper.transform = glm::rotate(upper.transform, 0.4f, glm::vec3(0, 1, 0));
        upper.self_collision = true;
        add(upper);
        (void)take(solver().add_collider(voile::PlaneCollider{}));
        anchor_ = take(solver().add_anchor(glm::mat4(1)));
        take(solver().set_attachments(cloths[1], std::vector{voile::pin(0).to(anchor_), voile::spring(11, 10, 0.01f)}));
        harness.upload();
    }

    void change(uint32_t frame) override
    {
        take(solver().move_anchor(anchor_, moved({0, 0.2f * static_cast<float>(frame) * k_frame, 0})));
        if (frame == 9)
            take(solver().set_material(cloths[0], voile::silk()));
    }

private:
    voile::AnchorId anchor_;
};

// Cloths and colliders come and go, buffers grow, substeps vary, a snapshot is restored.
class Changes : public Scene
{
public:
    explicit Changes(const voile::SolverOptions& options) : Scene(options)
    {
        add(sheet(0.2f, voile::Integrator::verlet));
        ball_ = take(solver().add_collider(voile::SphereCollider{.center = {0, 0, 0}, .radius = 0.15f}));
        harness.upload();
    }

    void change(uint32_t frame) override
    {
        next.gust = frame < 6 ? 0 : 0.3f; // changes push constants alone
        if (frame == 12)
            grow();
        if (frame == 18)
            take(solver().set_enabled(cloths[0], false));
        if (frame == 19)
            take(solver().remove(ball_));
        if (frame == 25)
            take(solver().set_enabled(cloths[0], true));
        if (frame == 28)
            save_and_restore();
        if (frame == 35)
            remove_first();
    }

private:
    void grow()
    {
        next.substeps = 5; // odd: contact ends in another buffer
        add(sheet(0.22f, voile::Integrator::rk4));
        const voile::engine::Mesh box = voile::engine::make_box({-0.1f, 0.1f, -0.1f}, {0.1f, 0.17f, 0.1f});
        (void)take(solver().add_collider(tests::collider(box)));
        harness.upload();
        take(solver().set_material(cloths[0], voile::denim()));
    }

    void save_and_restore()
    {
        const voile::Snapshot snapshot = take(solver().create_snapshot());
        harness.run([&](VkCommandBuffer cmd) { take(solver().record_save(cmd, snapshot)); });
        harness.step(step(0));
        harness.run([&](VkCommandBuffer cmd) { take(solver().record_restore(cmd, snapshot)); });
    }

    void remove_first()
    {
        take(solver().remove(cloths[0]));
        cloths.erase(cloths.begin());
    }

    voile::ColliderId ball_;
};

// Returns how many steps used the commands of earlier ones.
template <typename Which>
uint32_t compare(uint32_t frames)
{
    Which plain{voile::SolverOptions{}};
    Which reuses{reusing()};
    uint32_t reused = 0;
    for (uint32_t frame = 1; frame <= frames; ++frame)
    {
        CAPTURE(frame);
        for (Scene* scene : {static_cast<Scene*>(&plain), static_cast<Scene*>(&reuses)})
        {
            scene->change(frame);
            scene->harness.step(scene->step(frame));
        }
        CHECK_FALSE(plain.harness.solver.record_report().reused);
        reused += reuses.harness.solver.record_report().reused ? 1 : 0;
        for (size_t i = 0; i < plain.cloths.size(); ++i)
        {
            REQUIRE(
                tests::same_bits(plain.harness.positions(plain.cloths[i]), reuses.harness.positions(reuses.cloths[i])));
            REQUIRE(tests::same_bits(plain.harness.velocities(plain.cloths[i]),
                                     reuses.harness.velocities(reuses.cloths[i])));
        }
    }
    CHECK(plain.harness.statistics().contacts > 0);
    return reused;
}

} // namespace

// One case: each process makes its own pipelines.
TEST_CASE("steps that use commands again are equal to the bit, whatever moves, deforms and changes")
{
    CHECK(compare<MovingColliders>(12) == 8);
    CHECK(compare<Deforming>(12) == 8);
    CHECK(compare<Pairs>(12) == 8);
    CHECK(compare<Changes>(40) == 12);
}

TEST_CASE("the report of a step counts the commands that it recorded")
{
    tests::GpuFixture fixture;
    voile::SolverOptions options = reusing();
    options.output.previous_positions = true;
    auto solver = take(voile::Solver::create(tests::CountedCommands::handles(), options));
    CHECK(solver.record_report().commands == 0);
    const voile::ClothId cloth = take(solver.add_cloth(sheet(0.2f, voile::Integrator::verlet)));
    voile::Upload upload;
    fixture.run([&](VkCommandBuffer cmd) { upload = take(solver.record_upload(cmd)); });
    uint32_t first = 0;
    uint32_t last = 0;
    for (uint32_t i = 0; i < 12; ++i)
    {
        CAPTURE(i);
        if (i % 3 == 0)
            take(solver.teleport(cloth, moved({0, 0.001f, 0}))); // not part of what is used again
        tests::CountedCommands::begun = tests::CountedCommands::count = 0;
        fixture.run([&](VkCommandBuffer cmd) { take(solver.record(cmd, {.substeps = 20})); });
        const voile::RecordReport report = solver.record_report();
        CHECK(report.commands == tests::CountedCommands::count);
        // Two command buffers in turn. Each is recorded when the same passes come for the second time.
        CHECK(tests::CountedCommands::begun == (i == 2 || i == 3 ? 1 : 0));
        CHECK(report.reused == (i >= 4));
        (i == 0 ? first : last) = report.commands;
    }
    CHECK(first > 80);
    CHECK(last < 12);
    CHECK_FALSE(solver.record(VkCommandBuffer{}, {.duration = -1}));
    CHECK(solver.record_report().commands == 0);
    CHECK_FALSE(solver.record_report().reused);
}

TEST_CASE(
    "recorders count the dispatches of commands that are used again, and steps with a split or timestamps have none")
{
    ClothHarness harness(reusing());
    (void)take(harness.solver.add_cloth(sheet(0.2f, voile::Integrator::verlet)));
    harness.upload();
    const voile::Step step{.substeps = 4};
    for (uint32_t i = 0; i < 6; ++i)
    {
        CHECK(tests::recorded_dispatches(harness, step) == harness.solver.dispatches(step));
        CHECK(harness.solver.record_report().reused == (i >= 4));
    }
    auto timestamps =
        take(voile::gpu::Timestamps::create(tests::solver_context(), tests::device().queue_family(), 1, 100));
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            timestamps.begin_frame(cmd, 0);
            take(harness.solver.record(cmd, step, &timestamps));
        });
    CHECK_FALSE(harness.solver.record_report().reused);
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            voile::gpu::Recorder recorder(tests::solver_context(), cmd);
            recorder.split_with([](void*, VkCommandBuffer same) { return same; }, nullptr);
            take(harness.solver.record(recorder, step));
        });
    CHECK_FALSE(harness.solver.record_report().reused);
    harness.step(step);
    CHECK(harness.solver.record_report().reused);
}

TEST_CASE("forgotten commands are not used again")
{
    tests::GpuFixture fixture;
    const voile::gpu::Context& context = tests::solver_context();
    auto commands = take(voile::StepCommands::create(
        context, {.queue_family = tests::device().queue_family(), .steps_in_flight = 1}, false));
    for (uint32_t i = 0; i < 10; ++i)
    {
        CAPTURE(i);
        if (i == 6) // buffers were replaced
            commands.forget();
        fixture.run(
            [&](VkCommandBuffer cmd)
            {
                voile::gpu::Recorder recorder(context, cmd);
                commands.begin(recorder);
                recorder.barrier(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, 0,
                                 VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT_KHR, 0);
                commands.end(recorder);
                CHECK(recorder.commands() == 1);
            });
        CHECK(commands.reused() == (i == 4 || i == 5));
    }
}

TEST_CASE("options of command reuse that do not fit the device are refused by name")
{
    const auto refused = [](uint32_t family, uint32_t steps)
    {
        voile::SolverOptions options;
        options.command_reuse = {.queue_family = family, .steps_in_flight = steps};
        return tests::reason(voile::Solver::create(tests::test_handles(), options));
    };
    CHECK(refused(tests::device().queue_family(), 0) == "CommandReuse: steps_in_flight is 0, must be 1 to 16");
    CHECK(refused(tests::device().queue_family(), 17) == "CommandReuse: steps_in_flight is 17, must be 1 to 16");
    CHECK(refused(99, 2).starts_with("CommandReuse: queue_family is 99, the device has "));
    CHECK(refused(tests::device().queue_family(), 16) == "accepted");
}

TEST_CASE("a step whose commands the GPU still executes is refused, and works once they have completed")
{
    tests::GpuFixture fixture;
    voile::SolverOptions options = reusing();
    options.lifetime_checks = true;
    auto solver = take(voile::Solver::create(tests::CountedCommands::handles(), options));
    (void)take(solver.add_cloth(sheet(0.2f, voile::Integrator::verlet)));
    voile::Upload upload;
    fixture.run([&](VkCommandBuffer cmd) { upload = take(solver.record_upload(cmd)); });
    const voile::Step step{.substeps = 2};
    for (int i = 0; i < 4; ++i)
        fixture.run([&](VkCommandBuffer cmd) { take(solver.record(cmd, step)); });

    tests::Gate gate(tests::device());
    voile::engine::FrameRing frames(tests::device(), 2);
    tests::CountedCommands::in_execution = [&](VkCommandBuffer cmd) { gate.record(cmd); };
    const voile::engine::FrameRing::Frame first = frames.begin();
    take(solver.record(first.cmd, step));
    tests::CountedCommands::in_execution = nullptr;
    frames.submit(first);
    gate.wait_until_reached();
    const voile::engine::FrameRing::Frame second = frames.begin();
    take(solver.record(second.cmd, step)); // the other command buffer
    const auto third = solver.record(second.cmd, step);
    CHECK(tests::reason(third) ==
          "CommandReuse: steps_in_flight is too low: the GPU executes the step of 2 calls before");
    CHECK(solver.record_report().commands == 0);
    gate.open();
    frames.wait(first.slot);
    CHECK(solver.record(second.cmd, step));
    CHECK(solver.record_report().reused);
    frames.submit(second);
    frames.wait_all();
}
