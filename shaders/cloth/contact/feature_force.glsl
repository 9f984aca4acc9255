// The force that features exert on a vertex between two contact passes.
//
// The including kernel declares feature_forces[] and includes step_input.glsl before.
#ifndef VOILE_FEATURE_FORCE_GLSL
#define VOILE_FEATURE_FORCE_GLSL

uint force_index(uint vertex, uint slot) { return 2 * vertex + slot; }

// m/s^2, after the pass of a substep of the step, whose forces are in a slot.
vec3 force_after(uint vertex, uint slot, uint substep)
{
    const FeatureForce force = feature_forces[force_index(vertex, slot)];
    return force.substep == counted_substep(substep) ? force.acceleration : vec3(0);
}

#endif
