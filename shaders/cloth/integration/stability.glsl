// Stability scales of viscosity and air.
#ifndef VOILE_STABILITY_GLSL
#define VOILE_STABILITY_GLSL

#include "shared/stability.h"

struct Viscosity
{
    bool is_on;
    float scale;     // s, at full viscosity; a fraction of the substep
    float sharpness; // a relative change of length beyond the threshold, times this, is the fraction of `scale`, up to 1
};

const Viscosity k_no_viscosity = Viscosity(false, 0, 0);

// The viscosity of fast springs under Verlet (forces.glsl). Damping may use what the flat cloth leaves of the stability
// region: D up to twice that, of which less than half acts along a spring and less than half across it. A short substep
// needs none: viscosity vanishes with the fourth power of the substep, faster than the method's own error.
Viscosity viscosity_of(StabilityScales scales, float flat_omega_squared, float decay, float h)
{
    const float softened = scales.stiffness * flat_omega_squared;
    const float flat_load = verlet_load(softened, scales.damping * decay + scales.retardation * softened, h);
    const float strength = softened * h * h;
    const float most = min(0.15, 0.8 * max(1 - flat_load, 0) / max(strength, 1e-30)); // of load^1.5 h
    return Viscosity(true, scales.load * sqrt(scales.load) * h * most, 1 / max(most, 1e-6));
}

// The stability scale of the air's force, whose decay rate is `decay`, in a substep of h seconds. A force quadratic in
// the velocity grows twice as fast with it as its rate says. It may use the margin of the stability region.
float air_scale(bool verlet, float decay, float h)
{
    const float region = verlet ? 1 - VOILE_STABILITY_MARGIN * VOILE_STABILITY_MARGIN
                               : VOILE_RK4_RADIUS * (1 - VOILE_STABILITY_MARGIN);
    return min(1, 0.5 * region / max(decay * h, 1e-30));
}

// Where steps differ in their length and a budget leaves too few substeps, the longest of the last time decide (Softening in
// stability.hpp). `h`: s, of the substep.
StabilityScales scales_of(bool verlet, uint cloth, float h)
{
    return stability_scales(verlet, cloths[cloth].omega_squared, cloths[cloth].decay,
                            max(h, cloths[cloth].softened_substep));
}

#endif
