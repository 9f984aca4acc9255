// What a collider or an impulse of pairs gives a vertex. Guards cut it, for nothing could know of it when they were made. So
// the vertex keeps the velocity, and the next pass hands it on.
#ifndef VOILE_DRIVE_GLSL
#define VOILE_DRIVE_GLSL

struct Drive
{
    vec3 direction; // unit; 0: nothing
    float speed;    // m/s, along it
};

const Drive k_no_drive = Drive(vec3(0), 0);

// m/s: what cloth that a moving collider or pin pushes gives other cloth in a pass. Cloth at rest gives less.
const float k_push = 0.5;

// What of an impulse is in a velocity.
Drive drive_of(vec3 impulse, vec3 v)
{
    const float size = length(impulse);
    const vec3 direction = impulse / max(size, 1e-30);
    return Drive(direction, clamp(dot(v, direction), 0, size));
}

// `carry`: m/s, of what the drive is relative to.
void keep(Drive drive, vec3 carry, inout vec3 v)
{
    if (drive.speed > 0)
        v += max(drive.speed - dot(v - carry, drive.direction), 0) * drive.direction;
}

#endif
