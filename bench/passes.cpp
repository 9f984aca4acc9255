#include "passes.hpp"

#include <cstdio>
#include <numeric>

namespace bench
{

namespace
{

constexpr uint32_t k_most_passes = 16384;

} // namespace

PassTimes::PassTimes(TimedQueue& queue)
    : timestamps_(voile::engine::take(
          voile::gpu::Timestamps::create(queue.context(), queue.device().queue_family(), 1, k_most_passes)))
{
}

void PassTimes::record(VkCommandBuffer cmd, voile::Solver& solver, const voile::Step& step)
{
    timestamps_.begin_frame(cmd, 0);
    voile::engine::take(solver.record(cmd, step, &timestamps_));
}

void PassTimes::read()
{
    for (const auto& pass : timestamps_.read(0))
        times_[std::string(pass.name)].push_back(pass.milliseconds * 1000);
}

void PassTimes::print(uint32_t substeps) const
{
    for (const auto& [name, values] : times_)
        std::printf("    %-24s %8.3f us a substep, mean %8.3f\n", name.c_str(), quantile(values, 0.5) / substeps,
                    std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()) / substeps);
}

void print_passes(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, const TimedQueue::Record& restore)
{
    constexpr int k_steps = 21;
    PassTimes passes(queue);
    for (int i = 0; i < k_steps; ++i)
    {
        queue.run(
            [&](VkCommandBuffer cmd)
            {
                restore(cmd);
                passes.record(cmd, solver, step);
            });
        passes.read();
    }
    passes.print(step.substeps > 0 ? step.substeps : solver.stable_substeps(step.duration));
}

} // namespace bench
