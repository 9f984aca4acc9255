// The stability of explicit substeps, and the scales of stiffness and damping that follow. Float in GLSL, double in
// C++.
#ifndef VOILE_STABILITY_H
#define VOILE_STABILITY_H

#include "../../shared_types.h"

// The radius of RK4's stability region in the left half plane. The region extends to 2.83 along the imaginary axis and
// to 2.78 along the negative real axis. Its border is nowhere closer to the origin than this radius.
#define VOILE_RK4_RADIUS 2.6
// The fraction of the stability region that springs and their damping may use. Air and viscosity use the rest.
#define VOILE_STABILITY_MARGIN 0.95
// The part of what Verlet's springs and their damping may use that softened springs have for damping. Without it
// the strain limit, which moves vertices by a fraction of a millimeter in each step, makes them vibrate for ever.
#define VOILE_SOFTENED_DAMPING 0.3

VOILE_SHARED_BEGIN(voile)

// The load of a mode under velocity Verlet: the fraction of the stability region that it uses, from its frequency^2
// (1/s^2) and its decay rate (1/s). A substep of h seconds is stable up to a load of 1.
//
// The damping force sees a predicted velocity, v[n-1/2] + p h a[n-1]. With W = (omega h)^2 and D = decay h the
// characteristic polynomial is
//   z^3 + (W + (1 + p) D - 2) z^2 + (1 - (1 + 2 p) D) z + p D.
// Its roots lie in the unit circle up to W / 4 + (1/2 + p) D = 1. Second order needs p = 1/2 in the limit of short
// substeps. The longest substep needs p = 0. p = (1 - L) / 2 with L = W / 4 + D / 2 gives both, and the bound is L = 1.
VOILE_INLINE real verlet_load(real omega_squared, real decay, real h)
{
    return 0.25 * omega_squared * h * h + 0.5 * decay * h;
}

// Factors of a cloth's stiffness and damping in a substep. One pair for the whole cloth: forces stay equal and
// opposite, and the softened cloth has an energy of its own.
struct StabilityScales
{
    real stiffness; // 0..1
    real damping;   // 0..1
    real load;      // 0..1, under Verlet: the load of the scaled stiffness and damping
    // s, of softened springs: their damping over their stiffness (Kelvin and Voigt), besides their own damping
    real retardation;
};

// What exceeds the stability region is taken from the stiffness, and as much again for damping, until that takes
// VOILE_SOFTENED_DAMPING of the region.
VOILE_INLINE StabilityScales verlet_scales(real omega_squared, real decay, real h)
{
    const real region = VOILE_STABILITY_MARGIN * VOILE_STABILITY_MARGIN;
    const real elastic = verlet_load(omega_squared, 0, h);
    const real viscous = verlet_load(0, decay, h);
    const real excess = max(elastic + viscous - region, 0.0);
    StabilityScales scales;
    scales.stiffness = scales.damping = 1;
    scales.retardation = 0;
    if (excess > 0)
    {
        const real most = region * max(VOILE_SOFTENED_DAMPING, viscous / (elastic + viscous));
        const real damped = min(viscous + excess, most);
        scales.damping = min(1.0, damped / max(viscous, 1e-30));
        scales.stiffness = min(1.0, (region - damped) / max(elastic, 1e-30));
        scales.retardation =
            0.5 * h * max(damped - scales.damping * viscous, 0.0) / max(scales.stiffness * elastic, 1e-30);
    }
    scales.load = scales.stiffness * elastic + scales.damping * viscous;
    return scales;
}

VOILE_INLINE StabilityScales rk4_scales(real omega_squared, real decay, real h)
{
    const real radius = VOILE_STABILITY_MARGIN * VOILE_RK4_RADIUS / h;
    StabilityScales scales;
    scales.stiffness = min(1.0, radius * radius / max(omega_squared, 1e-30));
    scales.damping = min(1.0, radius / max(decay, 1e-30));
    scales.load = 0;
    scales.retardation = 0;
    return scales;
}

VOILE_INLINE StabilityScales stability_scales(bool verlet, real omega_squared, real decay, real h)
{
    if (verlet)
        return verlet_scales(omega_squared, decay, h);
    return rk4_scales(omega_squared, decay, h);
}

// The p of verlet_load.
VOILE_INLINE real verlet_prediction(StabilityScales scales)
{
    return 0.5 * (1 - scales.load);
}

VOILE_SHARED_END

#endif
