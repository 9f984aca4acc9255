// Restraints: directions in which colliders and anchors restrain vertices, and how fast these move there.
#ifndef VOILE_RESTRAINTS_GLSL
#define VOILE_RESTRAINTS_GLSL

// Sums over restraints (VOILE_FRAME_SUMS).
struct Restraints
{
    vec3 mean;   // m/s, of the cloth
    bool wanted; // else the frame does not depend on them
    vec3 diagonal;
    vec3 beside;
    vec3 drives;
    float squares;
};

// m/s: a restraint counts more if the mean motion of the cloth leads against it by more. Few vertices that are stopped would be
// led into what stops them.
const float k_slow = 0.25;
const float k_most_weight = 1000;

Restraints no_restraints(vec3 mean, bool wanted) { return Restraints(mean, wanted, vec3(0), vec3(0), vec3(0), 0); }

// `against`: m/s.
float weight_of(float against) { return min(1 + against * against / (k_slow * k_slow), k_most_weight); }

// By a surface of velocity `surface`, m/s. `n`: unit, away from it. `v`: m/s, of the vertex, which may leave the surface.
void restrain(inout Restraints restraints, vec3 n, vec3 surface, vec3 v)
{
    const float drive = max(dot(n, surface), dot(n, v));
    const float weight = weight_of(max(drive - dot(n, restraints.mean), 0));
    restraints.diagonal += weight * n * n;
    restraints.beside += weight * n.yzx * n.zxy;
    restraints.drives += weight * drive * n;
    restraints.squares += weight * drive * drive;
}

// In all directions.
void restrain(inout Restraints restraints, vec3 v)
{
    const float weight = weight_of(distance(v, restraints.mean));
    restraints.diagonal += weight;
    restraints.drives += weight * v;
    restraints.squares += weight * dot(v, v);
}

void add(inout Restraints restraints, Restraints other, float part)
{
    restraints.diagonal += part * other.diagonal;
    restraints.beside += part * other.beside;
    restraints.drives += part * other.drives;
    restraints.squares += part * other.squares;
}

#endif
