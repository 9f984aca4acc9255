// Coulomb friction between a fabric and a collider.
#ifndef VOILE_FRICTION_GLSL
#define VOILE_FRICTION_GLSL

// A pair's coefficient is the geometric mean of both sides' (Box2D's rule); a collider without one takes the fabric's.
float pair_friction(float fabric, float collider, uint flags)
{
    return (flags & VOILE_COLLIDER_FRICTION) != 0 ? sqrt(fabric * collider) : fabric;
}

// m/s: the coefficient falls from the static to the kinetic one while the slip speed rises to this (Stribeck 1902).
const float k_slip_range = 1e-3;

// m/s: what friction leaves of the tangential speed of a vertex that slips. `normal_impulse`: per unit of mass, m/s. With a
// jump from static to kinetic friction, the least slip that a substep knows would load stiff springs by more than a vertex
// weighs, and one vertex that gives way by a nanometer would take the whole cloth along. Impulses so large that the range is
// crossed within the substep meet kinetic friction at once.
float slip_speed(float speed, float normal_impulse, float static_friction, float kinetic_friction)
{
    const float kinetic = max(speed - kinetic_friction * normal_impulse, 0);
    const float fall = (static_friction - kinetic_friction) * normal_impulse;
    if (fall >= k_slip_range)
        return kinetic;
    const float beyond_static = max(speed - static_friction * normal_impulse, 0);
    return min(beyond_static * k_slip_range / (k_slip_range - fall), kinetic);
}

#endif
