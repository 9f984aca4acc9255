// What keeps an explicit step stable: the scales of stiffness and damping that a step of a given length bears.
//
// The same formulas stand in modules/cloth/src/stability.cpp, which derives the substeps from them. The including kernel
// declares a constant VERLET: whether it is that method's; else RK4's.
#ifndef VOILE_STABILITY_GLSL
#define VOILE_STABILITY_GLSL

// RK4's stability region reaches 2.83 along the imaginary axis, 2.78 along the negative real one, and in the left half
// plane comes nowhere nearer to the origin than 2.6.
const float k_rk4_reach = 2.6;
// What springs and their damping may take of the reach. Air and the viscosity of fast springs (forces.glsl) have the rest.
const float k_stability_margin = 0.95;

// How much of the step's reach a mode of frequency^2 `omega_squared` (1/s^2) and decay rate `decay` (1/s) takes up; a
// step is stable up to 1. Velocity Verlet whose damping force sees a predicted velocity, v[n-1/2] + p h a[n-1], has, with
// W = (omega h)^2 and D = decay h, the characteristic polynomial
//   z^3 + (W + (1 + p) D - 2) z^2 + (1 - (1 + 2 p) D) z + p D,
// whose roots are in the unit circle up to W / 4 + (1/2 + p) D = 1. Second order takes p = 1/2 in the limit of short
// steps; the longest step takes p = 0. With p = (1 - L) / 2, L = W / 4 + D / 2, both hold: the bound is L = 1.
float verlet_load(float omega_squared, float decay, float h)
{
    return 0.25 * omega_squared * h * h + 0.5 * decay * h;
}

struct StabilityScales
{
    float stiffness; // 0..1
    float damping;   // 0..1
    float load;      // Verlet: what they leave takes up so much of the reach, 0..1
};

// The scales of a cloth's stiffness and damping that a step of h seconds bears, one for the whole cloth: forces stay equal
// and opposite, and the softened cloth has an energy of its own.
StabilityScales stability_scales(float omega_squared, float decay, float h)
{
    if (VERLET)
    {
        const float load = verlet_load(omega_squared, decay, h) / (k_stability_margin * k_stability_margin);
        const float scale = min(1, 1 / max(load, 1e-30));
        return StabilityScales(scale, scale, verlet_load(scale * omega_squared, scale * decay, h));
    }
    const float reach = k_stability_margin * k_rk4_reach / h;
    return StabilityScales(min(1, reach * reach / max(omega_squared, 1e-30)), min(1, reach / max(decay, 1e-30)), 0);
}

// p above, of a cloth with what the step leaves of its stiffness and damping.
float verlet_prediction(StabilityScales scales) { return 0.5 * (1 - scales.load); }

struct Viscosity
{
    float scale;     // s, a fraction of the substep
    float sharpness; // a change of length beyond what springs may have in a substep, times this, is the fraction of `scale`
};

const Viscosity k_no_viscosity = Viscosity(0, 0);

// How viscous fast springs may be under Verlet (forces.glsl). Damping may take what the flat cloth leaves of the reach: D up
// to twice that, of which less than half goes along a spring and across it each. A step far within the reach needs none:
// there it vanishes with the fourth power of the step, faster than the method's own error.
Viscosity viscosity_of(StabilityScales scales, float flat_omega_squared, float decay, float h)
{
    const float flat_load = verlet_load(scales.stiffness * flat_omega_squared, scales.damping * decay, h);
    const float strength = scales.stiffness * flat_omega_squared * h * h;
    const float most = min(0.15, 0.8 * max(1 - flat_load, 0) / max(strength, 1e-30)); // of load^1.5 h
    return Viscosity(scales.load * sqrt(scales.load) * h * most, 1 / max(most, 1e-6));
}

// The scale of the air's force, of decay rate `decay`, that a step of h seconds bears beside all else. What is quadratic
// in the velocity grows twice as fast with it as its rate says, and may take up what the margin leaves of the reach.
float air_scale(float decay, float h)
{
    const float reach =
        VERLET ? 1 - k_stability_margin * k_stability_margin : k_rk4_reach * (1 - k_stability_margin);
    return min(1, 0.5 * reach / max(decay * h, 1e-30));
}

#endif
