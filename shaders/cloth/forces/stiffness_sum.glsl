// The stiffness matrix of a vertex: the sum over its springs, and its largest eigenvalue.
#ifndef VOILE_STIFFNESS_SUM_GLSL
#define VOILE_STIFFNESS_SUM_GLSL

// Sum of stiffness * (d d^T) over the springs of a vertex: a symmetric matrix, N/m.
struct StiffnessSum
{
    vec3 diagonal; // xx yy zz
    vec3 mixed;    // xy xz yz
};

// Adds a spring along the unit vector d. Longer than at rest, l > L, its stiffness is k (L/l d d^T + (1 - L/l) I).
// Shorter, it buckles, and its stiffness is k d d^T.
void add_stiffness(inout StiffnessSum sum, float stiffness, vec3 d, float rest_over_length)
{
    const float along = stiffness * min(rest_over_length, 1);
    sum.diagonal += along * d * d + (stiffness - along);
    sum.mixed += along * vec3(d.x * d.y, d.x * d.z, d.y * d.z);
}

// The largest eigenvalue of the matrix (Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix").
float largest_eigenvalue(StiffnessSum m)
{
    const float mean = (m.diagonal.x + m.diagonal.y + m.diagonal.z) / 3;
    const vec3 d = m.diagonal - mean;
    const float p = sqrt((dot(d, d) + 2 * dot(m.mixed, m.mixed)) / 6);
    if (p <= 1e-6 * mean)
        return mean;
    const float determinant = d.x * (d.y * d.z - m.mixed.z * m.mixed.z) -
                              m.mixed.x * (m.mixed.x * d.z - m.mixed.z * m.mixed.y) +
                              m.mixed.y * (m.mixed.x * m.mixed.z - d.y * m.mixed.y);
    const float angle = acos(clamp(0.5 * determinant / (p * p * p), -1, 1)) / 3;
    return mean + 2 * p * cos(angle);
}

#endif
