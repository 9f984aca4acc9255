// The differences between RK4 and Verlet that other passes depend on.
#ifndef VOILE_INTEGRATOR_GLSL
#define VOILE_INTEGRATOR_GLSL

bool is_verlet(uint cloth_flags) { return (cloth_flags & VOILE_CLOTH_VERLET) != 0; }

// s: a force that changes a vertex's velocity by dv over `duration` s moves the vertex by this time times dv. It acts
// throughout a substep of RK4. In each of `kicks` equal substeps, Verlet kicks first, then drifts with the new velocity.
float drift_time(bool verlet, float duration, uint kicks) { return 0.5 * duration * (verlet ? 1 + 1 / float(kicks) : 1); }

#endif
