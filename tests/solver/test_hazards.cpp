// Checks that validation reports a missing barrier: otherwise "no messages" would prove nothing. Checks that it reports
// none in a whole step. There each dispatch has its own command buffer, so that validation of the submission compares
// them all: within one command buffer this layer misses writes after writes.
#include "support/cloth_harness.hpp"

#include "colliders/refit.hpp"
#include "solver/kernels.hpp"

#include "shared/bindings.h"
#include "shared/padded_layout.h"
#include "shared/statistics_layout.h"
#include "voile/engine/assets/shapes.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <initializer_list>
#include <utility>

namespace
{

using tests::ClothHarness;

// Two dispatches of a small kernel that reads the first buffer and writes the second.
class TwoDispatches : public tests::GpuFixture
{
public:
    TwoDispatches()
        : kernels_(voile::engine::take(voile::create_kernels(tests::solver_context(), {}))), first_(buffer("first")),
          second_(buffer("second")), third_(buffer("third")), bounds_(buffer("bounds")),
          pool_(voile::engine::take(voile::gpu::BindingPool::create(context(), 4, 12)))
    {
    }

    VkDescriptorSet bind(VkBuffer from, VkBuffer to)
    {
        return voile::engine::take(
            pool_.bind(kernels_.statistics_reduce, {{voile::binding::partials, from},
                                                    {voile::binding::statistics, to},
                                                    {voile::binding::pair_bounds, bounds_.handle()}}));
    }

    void record(VkCommandBuffer cmd, VkDescriptorSet a, VkDescriptorSet b, voile::gpu::Ordering ordering)
    {
        voile::gpu::Recorder recorder(tests::solver_context(), cmd);
        const voile::shared::StatisticsReducePush push{1, 0, 0};
        recorder.dispatch(kernels_.statistics_reduce, a, 64, 64, push, ordering);
        recorder.dispatch(kernels_.statistics_reduce, b, 64, 64, push);
    }

    // Returns the messages of a run and removes them from the log.
    std::vector<std::string> messages_of(const std::function<void(VkCommandBuffer)>& record_commands)
    {
        tests::device().validation().echo = false;
        run(record_commands);
        tests::device().validation().echo = true;
        std::vector<std::string> messages = tests::device().validation().messages();
        tests::device().validation().clear();
        return messages;
    }

    [[nodiscard]] VkBuffer first() const { return first_.handle(); }
    [[nodiscard]] VkBuffer second() const { return second_.handle(); }
    [[nodiscard]] VkBuffer third() const { return third_.handle(); }

private:
    [[nodiscard]] voile::gpu::Buffer buffer(const char* name) const
    {
        return voile::engine::take(
            voile::gpu::create_buffer(context(), name, 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, voile::Memory::device));
    }

    voile::Kernels kernels_;
    voile::gpu::Buffer first_;
    voile::gpu::Buffer second_;
    voile::gpu::Buffer third_;
    voile::gpu::Buffer bounds_; // of pairs, read where a step had passes over them
    voile::gpu::BindingPool pool_;
};

// Ends each command buffer after its dispatch, continues in a new one, and submits them all at once.
class OneDispatchEach
{
public:
    explicit OneDispatchEach(const voile::engine::Device& device) : device_(device)
    {
        VkCommandPoolCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
        info.queueFamilyIndex = device.queue_family();
        voile::engine::check(fn().vkCreateCommandPool(device.context().device(), &info, nullptr, &pool_),
                             "command pool");
    }
    ~OneDispatchEach() { fn().vkDestroyCommandPool(device_.context().device(), pool_, nullptr); }
    OneDispatchEach(const OneDispatchEach&) = delete;
    OneDispatchEach& operator=(const OneDispatchEach&) = delete;

    VkCommandBuffer begin()
    {
        VkCommandBufferAllocateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
        info.commandPool = pool_;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        VkCommandBuffer cmd = VK_NULL_HANDLE;
        voile::engine::check(fn().vkAllocateCommandBuffers(device_.context().device(), &info, &cmd), "command buffer");
        VkCommandBufferBeginInfo begin_info{};
        begin_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
        voile::engine::check(fn().vkBeginCommandBuffer(cmd, &begin_info), "command buffer");
        buffers_.push_back(cmd);
        return cmd;
    }

    static VkCommandBuffer next(void* self, VkCommandBuffer cmd)
    {
        auto& recorder = *static_cast<OneDispatchEach*>(self);
        voile::engine::check(recorder.fn().vkEndCommandBuffer(cmd), "command buffer");
        return recorder.begin();
    }

    void submit()
    {
        voile::engine::check(fn().vkEndCommandBuffer(buffers_.back()), "command buffer");
        std::vector<VkCommandBufferSubmitInfoKHR> infos;
        for (const VkCommandBuffer cmd : buffers_)
            infos.push_back({VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO_KHR, nullptr, cmd, 0});
        VkSubmitInfo2KHR info{};
        info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2_KHR;
        info.commandBufferInfoCount = static_cast<uint32_t>(infos.size());
        info.pCommandBufferInfos = infos.data();
        voile::engine::check(fn().vkQueueSubmit2KHR(device_.queue(), 1, &info, VK_NULL_HANDLE), "submission");
        device_.wait_idle();
    }

    [[nodiscard]] size_t count() const { return buffers_.size(); }

private:
    [[nodiscard]] const voile::gpu::DeviceFunctions& fn() const { return device_.context().fn; }

    const voile::engine::Device& device_;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    std::deque<VkCommandBuffer> buffers_;
};

// Records steps and submits each of their dispatches in a command buffer of its own. The number of command buffers.
size_t run_one_by_one(voile::Solver& solver, std::initializer_list<voile::Step> steps)
{
    OneDispatchEach buffers(tests::device());
    voile::gpu::Recorder recorder(tests::solver_context(), buffers.begin());
    recorder.split_with(OneDispatchEach::next, &buffers);
    for (const voile::Step& step : steps)
        voile::engine::take(solver.record(recorder, step));
    buffers.submit();
    return buffers.count();
}

bool mentions_hazard(const std::vector<std::string>& messages, const std::string& kind)
{
    return std::any_of(messages.begin(), messages.end(),
                       [&](const std::string& m) { return m.find("SYNC-HAZARD-" + kind) != std::string::npos; });
}

} // namespace

TEST_CASE_FIXTURE(TwoDispatches, "a read that does not wait for a write is reported")
{
    const VkDescriptorSet a = bind(first(), second());
    const VkDescriptorSet b = bind(second(), third());
    const auto broken = messages_of([&](VkCommandBuffer cmd) { record(cmd, a, b, voile::gpu::Ordering::unordered); });
    CHECK(mentions_hazard(broken, "READ-AFTER-WRITE"));
    const auto right = messages_of([&](VkCommandBuffer cmd) { record(cmd, a, b, voile::gpu::Ordering::ordered); });
    CHECK(right.empty());
}

TEST_CASE_FIXTURE(TwoDispatches, "a write that does not wait for a read is reported")
{
    const VkDescriptorSet a = bind(first(), second());
    const VkDescriptorSet b = bind(third(), first());
    const auto broken = messages_of([&](VkCommandBuffer cmd) { record(cmd, a, b, voile::gpu::Ordering::unordered); });
    CHECK(mentions_hazard(broken, "WRITE-AFTER-READ"));
}

TEST_CASE_FIXTURE(TwoDispatches, "a write that does not wait for a write is reported between command buffers")
{
    const VkDescriptorSet a = bind(first(), second());
    const VkDescriptorSet b = bind(third(), second());
    for (const auto ordering : {voile::gpu::Ordering::unordered, voile::gpu::Ordering::ordered})
    {
        OneDispatchEach buffers(tests::device());
        voile::gpu::Recorder recorder(tests::solver_context(), buffers.begin());
        recorder.split_with(OneDispatchEach::next, &buffers);
        const auto messages = messages_of(
            [&](VkCommandBuffer)
            {
                const voile::shared::StatisticsReducePush push{1, 0, 0};
                const voile::Kernels kernels = voile::engine::take(voile::create_kernels(tests::solver_context(), {}));
                recorder.dispatch(kernels.statistics_reduce, a, 64, 64, push, ordering);
                recorder.dispatch(kernels.statistics_reduce, b, 64, 64, push);
                buffers.submit();
            });
        CHECK(mentions_hazard(messages, "WRITE-AFTER-WRITE") == (ordering == voile::gpu::Ordering::unordered));
    }
}

TEST_CASE("a whole step has no hazard, each dispatch in its own command buffer")
{
    ClothHarness harness;
    voile::GridCloth grid;
    grid.transform[3] = {0, 0.5f, 0, 1};
    grid.columns = 20;
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    grid.columns = 7;
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0.2f, 0}, 0.3f, 8);
    (void)voile::engine::take(
        harness.solver.add_collider(voile::MeshCollider{.positions = ball.positions, .triangles = ball.triangles}));
    harness.upload();
    // One per dispatch, and one after the last: seven per substep, eight on CPU devices, and per step normals,
    // depenetration, which needs the normals of the start, and two queries for near features, of which the second has
    // no workgroups.
    const uint32_t of_substep = tests::device().is_cpu() ? 8 : 7;
    CHECK(run_one_by_one(harness.solver, {{.substeps = 3}, {.substeps = 2}}) == of_substep * 5 + 4 * 2 + 1 + 1);
}

// The host copies what it gets, without barriers of its own.
TEST_CASE("steps with previous positions and outputs have no hazard, each in its own command buffer")
{
    ClothHarness harness({.output = {.previous_positions = true}});
    const voile::ClothId sheet = voile::engine::take(harness.solver.add_cloth(voile::GridCloth{}));
    harness.upload();
    const auto make_buffer = [&](const char* name, VkBufferUsageFlags usage)
    {
        return voile::engine::take(
            voile::gpu::create_buffer(harness.context(), name, 1 << 20, usage, voile::Memory::device));
    };
    const voile::gpu::Buffer vertices =
        make_buffer("host vertices", VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    const voile::gpu::Buffer copies = make_buffer("host copies", VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const voile::OutputId output = voile::engine::take(harness.solver.add_output(
        sheet,
        {.buffer = vertices.handle(), .size = vertices.size(), .stride = 24, .position = 0, .previous_position = 12}));
    OneDispatchEach buffers(tests::device());
    voile::gpu::Recorder recorder(tests::solver_context(), buffers.begin());
    recorder.split_with(OneDispatchEach::next, &buffers);
    VkDeviceSize copied = 0;
    const auto copy = [&](VkCommandBuffer cmd, VkBuffer buffer)
    {
        const VkBufferCopy region{0, std::exchange(copied, copied + 1024), 1024};
        harness.context().fn.vkCmdCopyBuffer(cmd, buffer, copies.handle(), 1, &region);
    };
    for (const bool resets : {false, true, false, true})
    {
        if (resets)
            voile::engine::take(harness.solver.reset(sheet));
        voile::engine::take(harness.solver.record(recorder, {.substeps = 1}));
        copy(recorder.cmd(), harness.solver.vertices(sheet).previous_positions);
    }
    VkCommandBuffer cmd = OneDispatchEach::next(&buffers, recorder.cmd());
    for (int i = 0; i < 2; ++i)
    {
        voile::engine::take(harness.solver.record_outputs(cmd, {output, output}));
        copy(cmd, vertices.handle());
        cmd = OneDispatchEach::next(&buffers, cmd);
    }
    voile::engine::take(harness.solver.record(cmd, {.substeps = 1}));
    buffers.submit();
}

TEST_CASE("a step with several levels of substeps has no hazard, each dispatch in its own command buffer")
{
    voile::SolverOptions options;
    options.tuning.dispatch_vertices = 1;
    ClothHarness harness(options);
    voile::Fabric stiff;
    for (float& stiffness : stiff.stretch_stiffness)
        stiffness *= 100;
    for (const voile::Fabric& fabric : {voile::Fabric{}, stiff})
        for (const voile::Integrator integrator : {voile::Integrator::rk4, voile::Integrator::verlet})
        {
            const voile::ClothId cloth = voile::engine::take(
                harness.solver.add_cloth(voile::GridCloth{.material = fabric, .integrator = integrator}));
            voile::engine::take(harness.solver.set_attachments(cloth, {voile::pin(0), voile::spring(5, 1)}));
            voile::engine::take(harness.solver.set_tethers(cloth, voile::Tethers{}));
        }
    const voile::engine::Mesh box = voile::engine::make_box({-1, -1, -1}, {1, -0.01f, 1});
    (void)voile::engine::take(
        harness.solver.add_collider(voile::MeshCollider{.positions = box.positions, .triangles = box.triangles}));
    harness.upload();

    const voile::Step step{.duration = 2e-3f};
    const uint32_t dispatches = harness.solver.dispatches(step);
    CHECK(run_one_by_one(harness.solver, {step}) >= dispatches);
}

namespace
{

voile::GridCloth colliding_sheet(float height)
{
    voile::GridCloth grid;
    grid.columns = grid.rows = 10;
    grid.width = grid.depth = 0.2f;
    grid.transform[3] = {0, height, 0, 1};
    grid.integrator = voile::Integrator::verlet;
    grid.self_collision = true;
    return grid;
}

} // namespace

TEST_CASE("steps in which cloths collide with each other have no hazard, each dispatch in its own command buffer")
{
    ClothHarness harness;
    for (const float height : {0.f, 0.003f})
    {
        const voile::ClothId cloth = voile::engine::take(harness.solver.add_cloth(colliding_sheet(height)));
        voile::engine::take(harness.solver.set_attachments(cloth, {voile::pin(0)}));
    }
    harness.upload();
    const voile::Step step{.duration = 2e-3f};
    const uint32_t dispatches = harness.solver.dispatches(step);
    CHECK(run_one_by_one(harness.solver, {step, step}) > 2 * dispatches);
}

TEST_CASE("steps in which cloths fall asleep and wake have no hazard, each dispatch in its own command buffer")
{
    ClothHarness harness;
    for (const float height : {0.002f, 0.03f})
    {
        voile::GridCloth grid = colliding_sheet(height);
        grid.sleep_speed = 10;
        (void)voile::engine::take(harness.solver.add_cloth(grid));
    }
    const voile::ColliderId ball =
        voile::engine::take(harness.solver.add_collider(voile::SphereCollider{.center = {0, -1, 0}, .radius = 0.99f}));
    harness.upload();
    voile::Step step{.substeps = 2};
    harness.step(step, 28);
    glm::mat4 motion(1.f);
    motion[3].y = 0.001f;
    for (const bool moves : {false, true})
    {
        if (moves)
            voile::engine::take(harness.solver.move_collider(ball, motion));
        CHECK(run_one_by_one(harness.solver, {step, step, step}) > 3 * 20);
    }
}

TEST_CASE_FIXTURE(tests::GpuFixture, "a refit has no hazard, each dispatch in its own command buffer")
{
    const voile::RefitKernels kernels = voile::engine::take(voile::create_refit_kernels(context(), 16));
    constexpr uint32_t k_triangles = 100;
    constexpr VkDeviceSize k_bytes = 256 * sizeof(voile::shared::PaddedBox);
    constexpr VkBufferUsageFlags k_usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const auto buffer = [&](const char* name) {
        return voile::engine::take(voile::gpu::create_buffer(context(), name, k_bytes, k_usage, voile::Memory::device));
    };
    const voile::gpu::Buffer trees = buffer("trees");
    const voile::gpu::Buffer leaves = buffer("leaves");
    const voile::gpu::Buffer positions = buffer("positions");
    const voile::gpu::Buffer boxes = buffer("boxes");
    for (const voile::gpu::Buffer* filled : {&leaves, &positions})
        run([&](VkCommandBuffer cmd) { context().fn.vkCmdFillBuffer(cmd, filled->handle(), 0, VK_WHOLE_SIZE, 0); });
    voile::gpu::BindingPool pool = voile::engine::take(voile::gpu::BindingPool::create(context(), 1, 4));
    const VkDescriptorSet set =
        voile::engine::take(pool.bind(kernels.leaves, {{voile::binding::cloth_trees, trees.handle()},
                                                       {voile::binding::refit_leaves, leaves.handle()},
                                                       {voile::binding::refit_positions, positions.handle()},
                                                       {voile::binding::refit_boxes, boxes.handle()}}));
    OneDispatchEach buffers(tests::device());
    voile::gpu::Recorder recorder(context(), buffers.begin());
    recorder.split_with(OneDispatchEach::next, &buffers);
    voile::shared::TreeRecord tree{};
    tree.first_box = 1;
    tree.triangles = k_triangles;
    for (int step = 0; step < 2; ++step)
        voile::record_refit(recorder, kernels, set, tree);
    buffers.submit();
    CHECK(buffers.count() == recorder.dispatches() + 1);
}

TEST_CASE("steps whose substeps share contact have no hazard, each dispatch in its own command buffer")
{
    ClothHarness harness;
    voile::GridCloth grid;
    grid.columns = grid.rows = 10;
    grid.transform[3] = {0, 0.002f, 0, 1};
    grid.integrator = voile::Integrator::verlet;
    (void)voile::engine::take(harness.solver.add_cloth(grid));
    (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
    harness.upload();
    for (const uint32_t substeps : {7u, 8u}) // odd and even: the last contact pass differs
    {
        const voile::Step step{.duration = 1e-4f * static_cast<float>(substeps), .substeps = substeps};
        // With a contact pass in each: two per substep, the last half kick, normals.
        CHECK(harness.solver.dispatches(step) < 2 * substeps + 2);
        CHECK(run_one_by_one(harness.solver, {step, step}) > 2 * harness.solver.dispatches(step));
    }
}
