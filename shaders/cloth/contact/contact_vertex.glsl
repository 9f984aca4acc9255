// The vertex that contact works on.
#ifndef VOILE_CONTACT_VERTEX_GLSL
#define VOILE_CONTACT_VERTEX_GLSL

#include "shared/fine_position.glsl"

// The vertex within the substep.
struct Motion
{
    FinePosition from; // before the substep
    vec3 displacement; // m, since then
    vec3 v;            // m/s
    uint cloth;
};

// Rounded to float.
vec3 position_of(Motion motion) { return motion.from.x + motion.displacement; }

// Coulomb coefficients.
struct Friction
{
    float at_rest;
    float kinetic;
};

// What contact needs of the vertex's cloth.
struct ClothContact
{
    float thickness; // m
    Friction friction;
    vec3 normal; // at the vertex, for k_method_normal_ray
    uint layers;
};

#endif
