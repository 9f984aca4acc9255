// Coulomb friction: the speed that it leaves.
#ifndef VOILE_FRICTION_LAW_GLSL
#define VOILE_FRICTION_LAW_GLSL

// m/s: while the slip speed rises to this, the coefficient falls from static to kinetic (Stribeck 1902).
const float k_slip_range = 1e-3;

// m/s: the tangential speed that friction leaves a vertex that slips. `normal_impulse`: per unit of mass, m/s. If
// friction jumped from static to kinetic, the smallest slip within a substep would load stiff springs by more than the
// weight of a vertex, and one vertex that slips by a nanometer would take the whole cloth along. Impulses that cross
// the range within the substep get kinetic friction at once.
float slip_speed(float speed, float normal_impulse, float static_friction, float kinetic_friction)
{
    const float kinetic = max(speed - kinetic_friction * normal_impulse, 0);
    const float fall = (static_friction - kinetic_friction) * normal_impulse;
    if (fall >= k_slip_range)
        return kinetic;
    const float beyond_static = max(speed - static_friction * normal_impulse, 0);
    return min(beyond_static * k_slip_range / (k_slip_range - fall), kinetic);
}

// The fraction that friction, static and kinetic, takes of a slip, without a range. `normal`: what contact takes across the
// surface, in the same unit: m/s or m.
float friction_fraction(float normal, float slip, vec2 friction)
{
    const float slips = min(2 * max(slip - friction.x * normal, 0), max(slip - friction.y * normal, 0));
    return 1 - slips / max(slip, 1e-30);
}

#endif
