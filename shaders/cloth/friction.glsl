// Coulomb friction between a fabric and a collider.
#ifndef VOILE_FRICTION_GLSL
#define VOILE_FRICTION_GLSL

// A pair's coefficient is the geometric mean of both sides' (Box2D's rule); a collider without one takes the fabric's.
float pair_friction(float fabric, float collider, uint flags)
{
    return (flags & VOILE_COLLIDER_FRICTION) != 0 ? sqrt(fabric * collider) : fabric;
}

// m/s: the range of slip speeds in which the coefficient falls from the static to the kinetic one (Stribeck 1902).
const float k_slip_range = 1e-3;

// m/s: what friction leaves of the tangential speed of a vertex that slips. The range spans several substeps: with a jump from
// static to kinetic friction, the least slip that a substep knows would load stiff springs by more than a vertex weighs, and
// one vertex that gives way by a nanometer would take the whole cloth along. `normal_impulse`: per unit of mass, m/s.
float slip_speed(float speed, float normal_impulse, float static_friction, float kinetic_friction)
{
    const float fall = (static_friction - kinetic_friction) * normal_impulse;
    const float range = max(k_slip_range, 2 * fall);
    const float beyond_static = max(speed - static_friction * normal_impulse, 0);
    return max(min(beyond_static * range / (range - fall), speed - kinetic_friction * normal_impulse), 0);
}

#endif
