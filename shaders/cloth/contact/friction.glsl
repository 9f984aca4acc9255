// Coulomb friction between a fabric and a collider.
#ifndef VOILE_FRICTION_GLSL
#define VOILE_FRICTION_GLSL

// The coefficient of a pair is the geometric mean of both (as in Box2D). A collider without one takes the fabric's.
float pair_friction(float fabric, float collider, uint flags)
{
    return (flags & VOILE_COLLIDER_FRICTION) != 0 ? sqrt(fabric * collider) : fabric;
}

#include "contact/friction_law.glsl"

#endif
