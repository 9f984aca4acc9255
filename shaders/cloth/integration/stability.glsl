// Scales of the forces that fast springs and air add to a substep.
#ifndef VOILE_STABILITY_GLSL
#define VOILE_STABILITY_GLSL

#include "shared/stability.h"

struct Viscosity
{
    bool is_on;
    float scale;     // s, a fraction of the substep
    float sharpness; // a change of length beyond what springs may have in a substep, times this, is the fraction of `scale`
};

const Viscosity k_no_viscosity = Viscosity(false, 0, 0);

// How viscous fast springs may be under Verlet (forces.glsl). Damping may take what the flat cloth leaves of the reach: D up
// to twice that, of which less than half goes along a spring and across it each. A step far within the reach needs none:
// there it vanishes with the fourth power of the step, faster than the method's own error.
Viscosity viscosity_of(StabilityScales scales, float flat_omega_squared, float decay, float h)
{
    const float flat_load = verlet_load(scales.stiffness * flat_omega_squared, scales.damping * decay, h);
    const float strength = scales.stiffness * flat_omega_squared * h * h;
    const float most = min(0.15, 0.8 * max(1 - flat_load, 0) / max(strength, 1e-30)); // of load^1.5 h
    return Viscosity(true, scales.load * sqrt(scales.load) * h * most, 1 / max(most, 1e-6));
}

// The scale of the air's force, of decay rate `decay`, that a step of h seconds bears beside all else. What is quadratic
// in the velocity grows twice as fast with it as its rate says, and may take up what the margin leaves of the reach.
float air_scale(bool verlet, float decay, float h)
{
    const float reach = verlet ? 1 - VOILE_STABILITY_MARGIN * VOILE_STABILITY_MARGIN
                               : VOILE_RK4_REACH * (1 - VOILE_STABILITY_MARGIN);
    return min(1, 0.5 * reach / max(decay * h, 1e-30));
}

#endif
