// Rounding of positions in a collider's space.
#ifndef VOILE_ROUNDING_GLSL
#define VOILE_ROUNDING_GLSL

// m: distances below this are a few roundings of a coordinate near x.
float rounding(vec3 x)
{
    return 5e-7 * max(max(abs(x.x), abs(x.y)), abs(x.z));
}

#endif
