// The frame loop: its host cost in steady state.
#include "bench/allocations.hpp"
#include "support/kept_pipelines.hpp"

#include "voile/cloth_component.hpp"
#include "voile/engine/app/app.hpp"
#include "voile/engine/assets/shapes.hpp"
#include "voile/engine/scene/deforming_mesh.hpp"
#include "voile/engine/scene/static_mesh.hpp"

#include "voile/gpu/buffer.hpp"

#include <doctest/doctest.h>

TEST_CASE("frames after the first few allocate nothing on the heap")
{
    // Without validation: the layer's allocations would be counted.
    voile::engine::App app({.extent = {64, 36}, .headless = true, .timestamps = true});
    auto& world = app.scene().add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    world.collect_statistics = true;
    world.add_collider(voile::PlaneCollider{});
    app.scene().add("sheet").add<voile::component::Sheet>(world, app.uploads(),
                                                          voile::GridCloth{.columns = 8, .rows = 8},
                                                          voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    voile::Fabric stiff;
    for (float& stiffness : stiff.stretch_stiffness)
        stiffness *= 400;
    app.scene().add("stiff").add<voile::component::Sheet>(world, app.uploads(),
                                                          voile::GridCloth{.columns = 8, .rows = 8, .material = stiff},
                                                          voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    app.scene().add("ground").add<voile::engine::StaticMesh>(app.uploads(), voile::engine::make_ground(10),
                                                             voile::engine::ground_surface());
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 1, 0}, 0.5f, 8);
    auto& deforming = app.scene().add("ball").add<voile::engine::DeformingMesh>(app.uploads(), app.slots(), ball,
                                                                                voile::engine::Surface{});
    for (int i = 0; i < 4; ++i) // uploads, both slots, the driver's own first uses
        REQUIRE(app.frame());
    const uint64_t before = bench::allocations();
    CHECK(before > 0); // the counter works
    for (int i = 0; i < 8; ++i)
    {
        deforming.set_positions(ball.positions);
        world.step.max_substeps = i % 2 == 0 ? 1 : 2000; // the sheets take the same number of substeps, or do not
        REQUIRE(app.frame());
    }
    CHECK(bench::allocations() - before == 0);
    app.finish();
}

// Once something is drawn, Mesa's llvmpipe takes times late (Timestamps::is_late).
TEST_CASE("the passes of cloth take the time of the cloth, also after pictures")
{
    voile::engine::App app({.extent = {64, 36}, .headless = true, .timestamps = true});
    auto& world = app.scene().add("cloth").add<voile::component::ClothWorld>(app.device(), app.slots());
    app.scene().add("sheet").add<voile::component::Sheet>(world, app.uploads(),
                                                          voile::GridCloth{.columns = 48, .rows = 48},
                                                          voile::component::fabric_surface({1, 0, 0}, {0, 0, 1}, 1));
    double cloth = 0;
    double passes = 0;
    app.completed = [&](const voile::engine::FrameInfo& frame)
    {
        if (frame.index < 2) // the driver compiles
            return;
        for (const voile::gpu::PassTime& pass : frame.timestamps->read(frame.slot))
            (pass.name == "cloth" ? cloth : passes) += pass.name.starts_with("cloth") ? pass.milliseconds : 0;
    };
    for (int i = 0; i < 6; ++i)
        REQUIRE(app.frame());
    app.finish();
    CHECK(passes > 0.5 * cloth);
    CHECK(passes <= cloth);
}

namespace
{

// Allocations of a step and outputs whose passes are those of earlier steps.
uint64_t allocations_of_a_step(const voile::SolverOptions& options, const voile::engine::Device& device)
{
    tests::KeptPipelines pipelines(device.context());
    voile::Solver solver = voile::engine::take(voile::Solver::create(pipelines.handles(), options));
    const voile::ClothId sheet = voile::engine::take(solver.add_cloth(voile::GridCloth{.columns = 8, .rows = 8}));
    constexpr VkDeviceSize k_bytes = 64 * 24;
    const voile::gpu::Buffer vertices = voile::engine::take(voile::gpu::create_buffer(
        device.context(), "host vertices", k_bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    const voile::OutputId output = voile::engine::take(solver.add_output(
        sheet, {.buffer = vertices.handle(), .size = k_bytes, .stride = 24, .position = 0, .previous_position = 12}));
    voile::engine::FrameRing frames(device, 1);
    voile::Upload upload;
    uint64_t result = 0;
    for (int i = 0; i < 8; ++i)
    {
        voile::engine::take(solver.teleport(sheet, glm::mat4(1)));
        const voile::engine::FrameRing::Frame frame = frames.begin();
        if (solver.needs_upload())
            upload = voile::engine::take(solver.record_upload(frame.cmd));
        const uint64_t before = bench::allocations();
        voile::engine::take(solver.record(frame.cmd, {}));
        voile::engine::take(solver.record_outputs(frame.cmd, {output}));
        result = bench::allocations() - before;
        frames.submit(frame);
    }
    CHECK(solver.record_report().reused == options.command_reuse.has_value());
    frames.wait_all();
    return result;
}

} // namespace

TEST_CASE("recording previous positions and outputs allocates nothing on the heap")
{
    const voile::engine::Device device(voile::engine::DeviceOptions{}); // without validation, as above
    voile::SolverOptions options{.output = {.previous_positions = true}};
    CHECK(allocations_of_a_step(options, device) == 0);
    options.command_reuse = {.queue_family = device.queue_family(), .steps_in_flight = 1};
    CHECK(allocations_of_a_step(options, device) == 0);
}
