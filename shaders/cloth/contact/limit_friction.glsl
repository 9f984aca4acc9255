// Friction of what the strain limit moves along a surface. The limit is a force between vertices that it never computes:
// it moves them. What it moves into a surface, contact lifts again, and that is the part of the displacement which its
// force would press with (as in position-based dynamics). Without this, cloth on a budget of substeps creeps off anything
// round.
//
// The including kernel includes friction_law.glsl before.
#ifndef VOILE_LIMIT_FRICTION_GLSL
#define VOILE_LIMIT_FRICTION_GLSL

// The pieces around a vertex press on features together, but it takes the largest of their lifts. With 1 silk of 1.5 m creeps
// off a ball of 0.35 m, in 8 substeps per step.
const float k_feature_pressing = 4;

// m: what friction takes of a displacement, m, on a surface with the normal n. `pressed`: m, along n; `friction`: static
// and kinetic.
vec3 held_after_limit(vec3 moved, vec3 n, float pressed, vec2 friction)
{
    const vec3 slid = moved - dot(moved, n) * n;
    return friction_fraction(pressed, length(slid), friction) * slid;
}

#endif
