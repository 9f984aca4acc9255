// Constants of mathematics.
#ifndef VOILE_CONSTANTS_GLSL
#define VOILE_CONSTANTS_GLSL

const float k_two_pi = 6.28318531;

#endif
