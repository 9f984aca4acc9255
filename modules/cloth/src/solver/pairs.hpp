// The passes over pairs of near primitives of cloths, within a step.
#pragma once

#include "solver/solver_state.hpp"

#include "shared/pair_layout.h"

namespace voile
{

// Records the passes at the beginning of those substeps that have one.
class PairRecorder
{
public:
    // `substeps`: of level 0, per step.
    PairRecorder(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists, const Step& step,
                 uint32_t substeps);

    // Whether a substep begins with a pass. The first one of a step does.
    [[nodiscard]] bool begins(uint32_t substep) const { return substep % period_ == 0; }
    // `in_stage_b`: where the substep begins.
    void record(uint32_t substep, bool in_stage_b);

private:
    void find(const shared::PairPush& push, size_t from);

    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    uint32_t threads_; // for all patches
    uint32_t substeps_;
    uint32_t period_; // substeps from one pass to the next
    float h_;         // s
};

} // namespace voile
