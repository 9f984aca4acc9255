// The input of the step, and what push constants of its passes mean with it.
#ifndef VOILE_STEP_INPUT_GLSL
#define VOILE_STEP_INPUT_GLSL

#include "shared/step_layout.h"

layout(VOILE_UNIFORM_BINDING(step_inputs)) uniform StepInputs { StepInput step_input; };

// s, of so many substeps of level 0. Precise, so that a sum does not round otherwise than with the rounded product.
float seconds(float substeps)
{
    precise const float time = substeps * step_input.substep;
    return time;
}

// The number of a substep over all steps, from its number in the step.
uint counted_substep(uint substep) { return step_input.first_substep + substep; }

#endif
