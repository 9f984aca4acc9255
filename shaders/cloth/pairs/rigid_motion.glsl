// The motion of a rigid body.
#ifndef VOILE_RIGID_MOTION_GLSL
#define VOILE_RIGID_MOTION_GLSL

struct RigidMotion
{
    vec3 velocity;         // m/s, of its origin
    vec3 angular_velocity; // rad/s
};

// m/s, `r` from the origin.
vec3 velocity_at(RigidMotion motion, vec3 r) { return motion.velocity + cross(motion.angular_velocity, r); }

#endif
