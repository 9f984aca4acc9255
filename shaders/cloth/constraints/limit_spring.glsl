// The correction of one spring by the strain limit, for one of its ends.
#ifndef VOILE_LIMIT_SPRING_GLSL
#define VOILE_LIMIT_SPRING_GLSL

#include "forces/stiffness_sum.glsl"

struct Correction
{
    vec3 x;             // m
    vec3 v;             // m/s
    StiffnessSum taken; // of the springs beyond a bound: sum of fraction * (n n^T)
};

const Correction k_no_correction = Correction(vec3(0), vec3(0), StiffnessSum(vec3(0), vec3(0)));

// The end of a spring and its relaxation, the fraction of a correction that it takes. Both ends take the smaller one,
// so that momentum is kept.
struct End
{
    vec3 x;             // m
    vec3 v;             // m/s
    float inverse_mass; // of all that moves with the vertex on its level, in any unit
    float relaxation;
};

// Safe for any vertex: up to eight springs in one line, each of which takes half.
const float k_safe_relaxation = 0.25;

// Contact returns a vertex that touches a collider to its surface. It therefore counts as heavier, and the vertices
// beside it take more of a correction. A spring returns its vertex, too, almost as a pin: moved by the limit, cloth on a budget
// of substeps shook at 1 m/s.
const float k_touching = 0.1; // times the inverse mass

float limit_inverse_mass(float inverse_mass, float flags)
{
    if ((uint(flags) & VOILE_VERTEX_HELD) != 0)
        return 0;
    return inverse_mass * ((uint(flags) & VOILE_VERTEX_TOUCHES) != 0 ? k_touching : 1.0);
}

// Springs beyond this fraction of their limit stop lengthening, too, or they would oscillate about it.
const float k_taut = 0.995;

// Of a correction, for the first end: the rest is the other's.
float fraction_of(End self, End other) { return self.inverse_mass / (self.inverse_mass + other.inverse_mass); }

// `shortest`: m, the least length that the spring may be corrected to; 0: any.
void add_limit(inout Correction correction, End self, End other, float longest, float shortest)
{
    const vec3 delta = other.x - self.x;
    const float distance = length(delta);
    const bool is_short = distance < shortest;
    const bool acts = self.inverse_mass > 0 && distance != 0 && (is_short || !(distance < k_taut * longest));
    const vec3 n = acts ? delta / distance : vec3(0); // without branches, all springs of a vertex are in flight at once
    const float fraction = acts ? fraction_of(self, other) : 0;
    const float weight = min(self.relaxation, other.relaxation) * fraction;
    add_stiffness(correction.taken, fraction, n, 1);
    correction.x += weight * (is_short ? distance - shortest : max(distance - longest, 0)) * n;
    correction.v += weight * (is_short ? 0 : max(dot(other.v - self.v, n), 0)) * n;
}

// The relaxation for which the passes converge, at most `relaxation`. Jacobi passes converge while the largest
// eigenvalue of the sum that a vertex takes is at most 1, as in a flat sheet. In crumpled cloth, whose springs fall
// into one line, it is up to twice that, and corrections would grow from pass to pass.
float stable_relaxation(StiffnessSum taken, float relaxation)
{
    const float squares = dot(taken.diagonal, taken.diagonal) + 2 * dot(taken.mixed, taken.mixed);
    if (relaxation * relaxation * squares <= 1) // the sum of the squared eigenvalues
        return relaxation;
    return min(relaxation, 1 / largest_eigenvalue(taken));
}

#endif
