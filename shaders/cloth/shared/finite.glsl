// Whether a vector is a number.
#ifndef VOILE_FINITE_GLSL
#define VOILE_FINITE_GLSL

bool is_finite(vec3 v) { return !any(isnan(v)) && !any(isinf(v)); }

#endif
