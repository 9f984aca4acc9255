// How many dispatches a step records.
#pragma once

#include "support/cloth_harness.hpp"

namespace tests
{

// Records a step and runs it.
inline uint32_t recorded_dispatches(ClothHarness& harness, const voile::Step& step)
{
    uint32_t dispatches = 0;
    harness.run(
        [&](VkCommandBuffer cmd)
        {
            voile::gpu::Recorder recorder(solver_context(), cmd);
            voile::engine::take(harness.solver.record(recorder, step));
            dispatches = recorder.dispatches();
        });
    return dispatches;
}

} // namespace tests
