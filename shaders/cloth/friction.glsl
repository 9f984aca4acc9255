// Coulomb friction between a fabric and a collider.
#ifndef VOILE_FRICTION_GLSL
#define VOILE_FRICTION_GLSL

// A pair's coefficient is the geometric mean of both sides' (Box2D's rule); a collider without one takes the fabric's.
float pair_friction(float fabric, float collider, uint flags)
{
    return (flags & VOILE_COLLIDER_FRICTION) != 0 ? sqrt(fabric * collider) : fabric;
}

#endif
