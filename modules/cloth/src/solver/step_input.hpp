// StepInput: what may differ between two steps with the same passes (step_layout.h).
#pragma once

#include "solver/solver_state.hpp"

namespace voile
{

// The input of a step. `first_substep`: counted over all steps.
shared::StepInput make_step_input(const Solver::State& solver, const StepHistory& history, const Step& step,
                                  const SubstepPlan& plan, uint32_t first_substep);

// Writes it for the passes that follow. Begins in the scope of transfers; ends in that of compute.
void record_step_input(gpu::Recorder& recorder, const DeviceState& device, const shared::StepInput& input);

} // namespace voile
