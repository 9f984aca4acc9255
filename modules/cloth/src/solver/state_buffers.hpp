// StateBuffers: names of the buffers that hold a state of all cloths.
#pragma once

#include "shared/bindings.h"

namespace voile
{

struct StateBuffers
{
    buffer::Name positions;
    buffer::Name residuals; // of the positions, what floats do not hold of them (fine_position.glsl)
    buffer::Name velocities;
};

// What the cloth is between steps.
constexpr StateBuffers k_state{buffer::positions, buffer::residuals, buffer::velocities};
// Written by stage 1, by stages 2 and 4, by stage 3.
constexpr StateBuffers k_stage_a{buffer::stage_a_positions, buffer::stage_a_residuals, buffer::stage_a_velocities};
constexpr StateBuffers k_stage_b{buffer::stage_b_positions, buffer::stage_b_residuals, buffer::stage_b_velocities};
constexpr StateBuffers k_stage_c{buffer::stage_c_positions, buffer::stage_c_residuals, buffer::stage_c_velocities};
// The state at the start of a step, of cloths with a strain limit.
constexpr StateBuffers k_step_start{buffer::step_start_positions, buffer::step_start_residuals,
                                    buffer::step_start_velocities};
// The state before the strain limit's guard: velocities stand in stage C's positions.
constexpr StateBuffers k_before_limit{buffer::stage_a_positions, buffer::stage_a_residuals, buffer::stage_c_positions};
// Where the motion of the next contact pass starts, if it spans several substeps of Verlet, which uses no other stage
// A.
constexpr StateBuffers k_contact_start{buffer::stage_a_positions, buffer::stage_a_residuals, buffer::velocities};
// Of even and of odd steps.
constexpr buffer::Name k_depenetration_votes[] = {buffer::depenetration_votes_even, buffer::depenetration_votes_odd};

} // namespace voile
