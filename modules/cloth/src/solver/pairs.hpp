// The passes over pairs of near primitives of cloths, within a step.
#pragma once

#include "solver/solver_state.hpp"

#include "shared/pair_layout.h"

namespace voile
{

// The number of substeps of level 0 from one pass to the next. Each pass can make new lists. `farthest`: m, how far
// colliders and anchors move in the step. Vertices that they push may not reach where lists end before the next pass.
uint32_t substeps_per_pass(const Solver::State& solver, const Step& step, uint32_t substeps, float farthest);

// s: how long lists last where passes are so far apart. The clock of their carries ends then.
float time_of_lists(float interval);

// m: how far gravity alone may carry a vertex meanwhile.
float fall_of_pairs(const Vec3& gravity, float list_time);

// Records the passes at the beginning of those substeps that have one.
class PairRecorder
{
public:
    PairRecorder(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists,
                 const SubstepPlan& plan);

    // The pass before a substep. `in_stage_b`: where the substep begins. The first pass of a step makes new lists,
    // later ones only if a vertex has asked for them.
    void record(uint32_t substep, bool in_stage_b);

private:
    void write_sizes();
    void find_tangles();
    void find(const shared::PairPush& push, size_t from);

    gpu::Recorder& recorder_;
    const Solver::State& solver_;
    uint32_t threads_; // for all patches
    uint32_t leaves_;  // of the hierarchy
    uint32_t substeps_;
    PairSchedule schedule_;
};

} // namespace voile
