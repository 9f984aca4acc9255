// The pass over pairs. The including kernel declares push (PairPush).
#ifndef VOILE_PAIR_PASS_GLSL
#define VOILE_PAIR_PASS_GLSL

#include "shared/step_input.glsl"

// Its number over all steps.
uint pair_pass() { return step_input.first_pair_pass + push.pass; }

// s, from this pass to the next.
float pair_interval() { return seconds(push.substeps); }

#endif
