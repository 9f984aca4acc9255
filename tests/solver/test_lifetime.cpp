// Lifetimes of objects, the checks that enforce them, and concurrent use by several threads.
#include "support/cloth_harness.hpp"
#include "support/collider_scenes.hpp"
#include "support/test_paths.hpp"

#include "shared/contact_layout.h"
#include "solver/lifetime_check.hpp"
#include "voile/engine/assets/shapes.hpp"

#include <sys/wait.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <deque>
#include <string>
#include <thread>

namespace
{

using tests::ClothHarness;

// Commands that the GPU has begun and cannot finish: they wait for an event that is never set.
class Stuck
{
public:
    explicit Stuck(const voile::gpu::Context& context)
        : context_(context), begun_(make_event(context)), never_(make_event(context)), frames_(tests::device(), 1)
    {
    }

    // Submits the commands of `record`, stuck at the first dispatch, and returns once the GPU has reached it.
    template <typename Record>
    void submit(const Record& record)
    {
        const voile::engine::FrameRing::Frame frame = frames_.begin();
        voile::gpu::Recorder recorder(context_, frame.cmd);
        recorder.split_with(&Stuck::wait_in, this);
        record(recorder);
        frames_.submit(frame);
        while (context_.fn.vkGetEventStatus(context_.device(), begun_) != VK_EVENT_SET)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    void wait_here(VkCommandBuffer cmd)
    {
        context_.fn.vkCmdSetEvent(cmd, begun_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
        context_.fn.vkCmdWaitEvents(cmd, 1, &never_, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                                    nullptr, 0, nullptr, 0, nullptr);
    }

private:
    static VkEvent make_event(const voile::gpu::Context& context)
    {
        VkEventCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_EVENT_CREATE_INFO;
        VkEvent event = VK_NULL_HANDLE;
        REQUIRE(context.fn.vkCreateEvent(context.device(), &info, nullptr, &event) == VK_SUCCESS);
        return event;
    }

    static VkCommandBuffer wait_in(void* user, VkCommandBuffer cmd)
    {
        auto& self = *static_cast<Stuck*>(user);
        if (!std::exchange(self.waits_, true))
            self.wait_here(cmd);
        return cmd;
    }

    voile::gpu::Context context_;
    VkEvent begun_;
    VkEvent never_;
    bool waits_ = false;
    voile::engine::FrameRing frames_;
};

struct End
{
    int signal = 0; // as a shell reports it: 128 and more
    std::string output;
};

// Runs a skipped test case of this program in a separate process.
End run_case(const std::string& name)
{
    const std::string command = '\'' + tests::program("test_lifetime").string() + "' --no-skip -tc='" + name + "' 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    End end;
    std::array<char, 256> piece{};
    while (fgets(piece.data(), piece.size(), pipe) != nullptr)
        end.output += piece.data();
    const int status = pclose(pipe);
    end.signal = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return end;
}

} // namespace

TEST_CASE("an upload and a snapshot may outlive their solver")
{
    voile::Upload upload;
    std::optional<voile::Snapshot> snapshot;
    {
        ClothHarness harness({.lifetime_checks = true});
        (void)voile::engine::take(harness.solver.add_cloth(tests::flat_sheet(6, 0.5f, 0)));
        harness.upload();
        (void)voile::engine::take(harness.solver.add_collider(voile::PlaneCollider{}));
        harness.run([&](VkCommandBuffer cmd) { upload = voile::engine::take(harness.solver.record_upload(cmd)); });
        snapshot = voile::engine::take(harness.solver.create_snapshot());
        harness.run([&](VkCommandBuffer cmd) { voile::engine::take(harness.solver.record_save(cmd, *snapshot)); });
    }
    CHECK(snapshot->bytes().size() ==
          36 * (3 * sizeof(glm::vec4) + sizeof(glm::uvec2)) + (VOILE_VOTE_WORDS + 16 + 6 + 1) * sizeof(uint32_t));
    float first = 0;
    std::memcpy(&first, snapshot->bytes().data(), sizeof(first));
    CHECK(first == -0.25f);
    const tests::GpuFixture fixture; // fails on a validation message
    upload = voile::Upload();
    snapshot.reset();
}

TEST_CASE("lifetime checks accept correct use and commands that are never submitted")
{
    ClothHarness harness({.lifetime_checks = true});
    (void)voile::engine::take(harness.solver.add_cloth(tests::flat_sheet(6, 0.5f, 0)));
    (void)voile::engine::take(harness.solver.add_collider(voile::SphereCollider{}));
    harness.upload();
    harness.step({}, 3);
    CHECK(harness.statistics().nan_vertices == 0);
    voile::engine::FrameRing frames(tests::device(), 1);
    const voile::engine::FrameRing::Frame frame = frames.begin();
    voile::engine::take(harness.solver.record(frame.cmd, {}));
    const voile::Upload dropped = voile::engine::take(harness.solver.record_upload(frame.cmd));
    tests::device().context().fn.vkEndCommandBuffer(frame.cmd);
}

TEST_CASE("a solver destroyed while its commands run (in a process of its own)" * doctest::skip())
{
    auto* stuck = new Stuck(tests::solver_context()); // its commands never end
    auto* fixture = new ClothHarness({.lifetime_checks = true});
    (void)voile::engine::take(fixture->solver.add_cloth(tests::flat_sheet(6, 0.5f, 0)));
    fixture->upload();
    stuck->submit([&](voile::gpu::Recorder& recorder)
                  { voile::engine::take(fixture->solver.record(recorder, {.substeps = 1})); });
    const voile::Solver gone = std::move(fixture->solver);
}

TEST_CASE("the object of a check destroyed while its commands run (in a process of its own)" * doctest::skip())
{
    auto* stuck = new Stuck(tests::solver_context());
    voile::LifetimeCheck check =
        voile::engine::take(voile::LifetimeCheck::create(tests::device().context(), "voile::Upload"));
    stuck->submit(
        [&](voile::gpu::Recorder& recorder)
        {
            check.begin(recorder.cmd());
            stuck->wait_here(recorder.cmd());
            check.end(recorder.cmd());
        });
    check = voile::LifetimeCheck();
}

TEST_CASE("lifetime checks end the program if an object is destroyed while its commands run")
{
    const std::pair<const char*, const char*> cases[] = {{"a solver destroyed while*", "voile::Solver"},
                                                         {"the object of a check destroyed*", "voile::Upload"}};
    for (const auto& [name, object] : cases)
    {
        const End end = run_case(name);
        CAPTURE(end.output);
        CHECK(end.output.find(std::string("voile: a ") + object +
                              " is destroyed while the GPU executes its commands\n") != std::string::npos);
        CHECK(end.signal == 128 + SIGABRT);
    }
}

TEST_CASE("several threads create, fill and record solvers of one device at once")
{
    const tests::GpuFixture fixture;
    const voile::engine::Mesh ball = voile::engine::make_sphere({0, 0, 0}, 0.4f, 24);
    std::array<std::string, 2> errors;
    std::deque<voile::engine::FrameRing>
        rings; // one pool each; their destructors wait for the queue, so not in the threads
    std::vector<std::thread> threads;
    for (std::string& error : errors)
    {
        voile::engine::FrameRing& frames = rings.emplace_back(tests::device(), 1);
        threads.emplace_back(
            [&]
            {
                try
                {
                    auto solver = voile::engine::take(voile::Solver::create(tests::device().context().handles, {}));
                    const voile::ClothId id = voile::engine::take(solver.add_cloth(tests::flat_sheet(12, 0.5f, 1)));
                    (void)voile::engine::take(solver.add_collider(tests::collider(ball)));
                    const voile::engine::FrameRing::Frame frame = frames.begin();
                    const voile::Upload upload = voile::engine::take(solver.record_upload(frame.cmd));
                    voile::engine::take(solver.record(frame.cmd, {}));
                    voile::engine::take(solver.record_statistics(frame.cmd, 0));
                    tests::device().context().fn.vkEndCommandBuffer(frame.cmd);
                    if (solver.vertices(id).vertices != 144)
                        error = "not uploaded";
                }
                catch (const std::exception& caught)
                {
                    error = caught.what();
                }
            });
    }
    for (std::thread& thread : threads)
        thread.join();
    for (const std::string& error : errors)
        CHECK(error.empty());
}
