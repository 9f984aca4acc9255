// What keeps an explicit step stable: the shares of stiffness and damping that a step of a given length bears.
//
// The same formulas stand in modules/cloth/src/stability.cpp, which derives the substeps from them. The including kernel
// declares a constant VERLET: whether it is that method's; else RK4's.
#ifndef VOILE_STABILITY_GLSL
#define VOILE_STABILITY_GLSL

#include "stiffness_sum.glsl"

// RK4's stability region reaches 2.83 along the imaginary axis, 2.78 along the negative real one, and in the left half
// plane comes nowhere nearer to the origin than 2.6.
const float k_rk4_reach = 2.6;
// At rest, a step uses at most this share of the reach: springs turn and stretch, and are then stiffer along one axis.
const float k_stability_margin = 0.95;

// How much of the step's reach a mode of frequency^2 `omega_squared` (1/s^2) and decay rate `decay` (1/s) takes up; a
// step is stable up to 1. Velocity Verlet whose damping force sees the predicted velocity, v[n-1/2] + h/2 a[n-1]: its
// characteristic polynomial z^3 + (W + 3/2 D - 2) z^2 + (1 - 2 D) z + D / 2, with W = (omega h)^2 and D = decay h, has
// its roots in the unit circle up to W / 4 + D = 1.
float verlet_load(float omega_squared, float decay, float h)
{
    return 0.25 * omega_squared * h * h + decay * h;
}

// The share that a Verlet step bears of stiffness which would take up `load` times what there is of the reach. The method
// has no damping of its own, and its energy, v^2 + omega^2 x^2 (1 - load), bounds nothing near a load of 1: springs that
// turn and stretch from substep to substep then heat the cloth up. What is softened anyway is therefore softened to half of
// the reach, by degrees, so that a cloth just beyond it is as one just within.
float verlet_share(float load)
{
    const float borne = min(1, 1 / max(load, 1e-30));
    return borne * max(borne, 0.5);
}

struct Shares
{
    float stiffness; // 0..1
    float damping;   // 0..1
};

// The shares of a cloth's stiffness and damping that a step of h seconds bears at rest.
Shares stable_shares(float omega_squared, float decay, float h)
{
    if (VERLET)
    {
        // Damping has what stiffness leaves: it takes energy out.
        const float reach = k_stability_margin * k_stability_margin;
        const float stiffness = verlet_share(verlet_load(omega_squared, decay, h) / reach);
        const float left = reach - stiffness * verlet_load(omega_squared, 0, h);
        return Shares(stiffness, stiffness < 1 ? min(1, left / max(decay * h, 1e-30)) : 1);
    }
    const float reach = k_stability_margin * k_rk4_reach / h;
    return Shares(min(1, reach * reach / max(omega_squared, 1e-30)), min(1, reach / max(decay, 1e-30)));
}

// The share of the air's force, of decay rate `decay`, that a step of h seconds bears beside all else. What is quadratic
// in the velocity grows twice as fast with it as its rate says, and may take up what the margin leaves of the reach.
float stable_air(float decay, float h)
{
    const float reach =
        VERLET ? 1 - k_stability_margin * k_stability_margin : k_rk4_reach * (1 - k_stability_margin);
    return min(1, 0.5 * reach / max(decay * h, 1e-30));
}

// The share of its acceleration by inner forces and linear drag that a vertex keeps, given what its springs amount to in
// their present directions. Below 1 only where cloth is crumpled or torn so far that it is stiffer than the margin foresees:
// the vertex then is as if it were heavier.
float stable_acceleration(float omega_squared, float decay, float h)
{
    if (VERLET)
        return verlet_share(verlet_load(omega_squared, decay, h));
    const float reach = k_rk4_reach / h;
    return min(1, min(reach * reach / max(omega_squared, 1e-30), reach / max(decay, 1e-30)));
}

#endif
