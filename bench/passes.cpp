#include "passes.hpp"

#include "voile/gpu/timestamps.hpp"

#include <cstdio>
#include <map>
#include <string>

namespace bench
{

void print_passes(TimedQueue& queue, voile::Solver& solver, const voile::Step& step, const TimedQueue::Record& restore)
{
    constexpr int k_steps = 21;
    constexpr uint32_t k_most_passes = 16384;
    auto timestamps = voile::engine::take(
        voile::gpu::Timestamps::create(queue.context(), queue.device().queue_family(), 1, k_most_passes));
    std::map<std::string, std::vector<double>> times;
    for (int i = 0; i < k_steps; ++i)
    {
        queue.run(
            [&](VkCommandBuffer cmd)
            {
                restore(cmd);
                timestamps.begin_frame(cmd, 0);
                voile::engine::take(solver.record(cmd, step, &timestamps));
            });
        for (const auto& pass : timestamps.read(0))
            times[std::string(pass.name)].push_back(pass.milliseconds * 1000);
    }
    const auto substeps =
        static_cast<double>(step.substeps > 0 ? step.substeps : solver.stable_substeps(step.duration));
    for (const auto& [name, values] : times)
        std::printf("    %-24s %8.3f us a substep\n", name.c_str(), quantile(values, 0.5) / substeps);
}

} // namespace bench
