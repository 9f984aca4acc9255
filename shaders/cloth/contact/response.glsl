// The response of a vertex to a surface: contact without bouncing, and Coulomb friction.
//
// The including kernel declares `float slip_time(Motion motion)`, s: the vertex moves by this time times the change of
// velocity that friction gives it.
#ifndef VOILE_RESPONSE_GLSL
#define VOILE_RESPONSE_GLSL

#include "contact/contact_vertex.glsl"
#include "contact/friction_law.glsl"

// Inside a collider the velocity that forces give a vertex decays in this time, s,
const float k_inside_time = 0.01;
// and stays below this speed, m/s: neighbors whose exits differ pull at each other.
const float k_inside_speed = 0.6;
// It cancels at most this fraction of the exit velocity, so that no vertex is held inside.
const float k_inside_back = 0.5;

// A surface that a vertex touches.
struct Surface
{
    vec3 normal;       // unit, world, away from the surface
    vec3 displacement; // m, of the surface during the motion
    vec3 velocity;     // m/s, of the surface
    float slop;        // m: a vertex this close to the offset surface rests on it
    Friction friction;
};

// `lift`: m, the correction along the normal.
void respond(inout Motion motion, Surface surface, float lift)
{
    const vec3 n = surface.normal;
    motion.displacement += lift * n;
    const vec3 relative = motion.v - surface.velocity;
    const float approach = min(dot(relative, n), 0);
    motion.v -= approach * n;
    const float normal_impulse = -approach; // per unit of mass, m/s
    if (normal_impulse == 0)
        return;

    const vec3 v_t = relative - dot(relative, n) * n;
    const float speed = length(v_t);
    if (speed <= surface.friction.at_rest * normal_impulse)
    {
        // Sticks. The sliding within this motion is undone, too, or a held vertex would creep by a h^2 / 2 per substep.
        // It is undone to the bit: roundings that add up would stretch stiff cloth until it slips.
        const float height = dot(motion.displacement - surface.displacement, n);
        motion.displacement = surface.displacement + (abs(height) > surface.slop ? height : 0) * n;
        motion.v -= v_t;
        return;
    }
    const vec3 change =
        (slip_speed(speed, normal_impulse, surface.friction.at_rest, surface.friction.kinetic) / speed - 1) * v_t;
    motion.v += change;
    motion.displacement += slip_time(motion) * change;
}

// Moves a vertex that is inside a collider with that collider and towards its exit. The exit adds no velocity. `exit`,
// `surface`: m/s, relative to the collider, and the collider's own.
void leave(inout Motion motion, vec3 exit, vec3 surface, float duration)
{
    vec3 own = motion.v - surface;
    own *= min(max(1 - duration / k_inside_time, 0), k_inside_speed / max(length(own), 1e-30));
    const float speed = length(exit);
    const vec3 outwards = exit / max(speed, 1e-30);
    own -= min(dot(own, outwards) + k_inside_back * speed, 0) * outwards;
    motion.v = surface + own;
    motion.displacement = duration * (motion.v + exit);
}

#endif
