// Sleep of cloths at rest. The GPU decides; the host only knows some of what wakes them.
#pragma once

#include "solver/solver_state.hpp"

namespace voile
{

// Marks the cloths that changes of the host wake in the step that is recorded, so that its edits write it: edits of the
// cloth itself, anchors that move, forces that change.
void mark_woken(Solver::State& solver, const Step& step);

// Writes the records of cloths that are marked. Between barriers of the caller's.
void record_woken(gpu::Recorder& recorder, Solver::State& solver);

// Which cloths sleep in the step, before all passes that leave them alone, and which patches are awake. Records nothing
// if none may sleep.
void record_wake(gpu::Recorder& recorder, const Solver::State& solver, const ActiveLists& lists);

// Which cloths fall asleep, at the end of the step. Records nothing if none may sleep.
void record_sleep(gpu::Recorder& recorder, const Solver::State& solver, uint32_t patches, const SubstepPlan& plan);

} // namespace voile
