// The differences between RK4 and Verlet that other passes depend on.
#ifndef VOILE_INTEGRATOR_GLSL
#define VOILE_INTEGRATOR_GLSL

bool is_verlet(uint cloth_flags) { return (cloth_flags & VOILE_CLOTH_VERLET) != 0; }

// s: a change dv of a vertex's velocity within a substep of h seconds moves the vertex by this time times dv. Forces
// act throughout a substep of RK4. Verlet kicks first, then drifts with the new velocity.
float drift_time(bool verlet, float h) { return verlet ? h : 0.5 * h; }

#endif
