// How colliders move: poses of the host's as the GPU reads them.
#include "colliders/collider_motion.hpp"

#include "geometry/rounding.hpp"

#include <cmath>

namespace voile
{

namespace
{

// Unit quaternions as x, y, z, w. GLM's own are not used: the order of their members is a setting of the host's, and in
// one program the linker keeps one copy of each function of GLM.
double dot(const glm::dvec4& a, const glm::dvec4& b)
{
    return (a.w * b.w + a.x * b.x) + (a.y * b.y + a.z * b.z);
}

// After Shepperd 1978: from the largest component.
glm::dvec4 rotation_of(const glm::dmat4& rigid)
{
    const glm::dmat4& m = rigid;
    const double squares[] = {m[0][0] - m[1][1] - m[2][2], m[1][1] - m[0][0] - m[2][2], m[2][2] - m[0][0] - m[1][1],
                              m[0][0] + m[1][1] + m[2][2]}; // of the components, times 4, less 1
    int largest = 3;
    for (int i = 0; i < 3; ++i)
        if (squares[i] > squares[largest])
            largest = i;
    glm::dvec4 q;
    q[largest] = std::sqrt(squares[largest] + 1) * 0.5;
    const double scale = 0.25 / q[largest];
    for (int i = 0; i < 3; ++i)
    {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        if (largest == 3)
            q[i] = (m[j][k] - m[k][j]) * scale;
        else if (i == largest)
            q.w = (m[j][k] - m[k][j]) * scale;
        else
            q[i] = (m[i][largest] + m[largest][i]) * scale;
    }
    return q * (1 / std::sqrt(dot(q, q)));
}

} // namespace

bool is_rigid(const glm::mat4& transform)
{
    constexpr float k_tolerance = 1e-4f;
    if (!finite(transform))
        return false;
    const glm::mat3 turn(transform);
    const glm::mat3 product = glm::transpose(turn) * turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row ? 1.f : 0.f)) <= k_tolerance))
                return false;
    const bool affine =
        transform[0].w == 0 && transform[1].w == 0 && transform[2].w == 0 && transform[3].w == 1; // the last row
    return affine && glm::determinant(turn) > 0;
}

shared::ColliderMotion make_motion(const ColliderModel& collider)
{
    // In double: floats are coarse far from the origin.
    const glm::dmat4 placement(collider.placement);
    const glm::dmat4 from = glm::dmat4(collider.pose.from) * placement;
    const glm::dmat4 to = glm::dmat4(collider.pose.to) * placement;
    const glm::dvec4 rotation_from = rotation_of(from);
    glm::dvec4 rotation_to = rotation_of(to);
    if (dot(rotation_from, rotation_to) < 0)
        rotation_to = -rotation_to; // the shorter way
    shared::ColliderMotion motion{};
    motion.rotation_from = glm::vec4(rotation_from);
    motion.rotation_to = glm::vec4(rotation_to);
    const glm::dvec4 origin(collider.origin, 1);
    const glm::dvec3 origin_from(from * origin);
    motion.origin = rounded(origin_from);
    motion.offset_from = origin_from - glm::dvec3(motion.origin);
    motion.offset_to = glm::dvec3(to * origin) - glm::dvec3(motion.origin);
    if (collider.deforming)
    {
        motion.first_from = collider.deforming->first_from();
        motion.first_to = collider.deforming->first_to();
        motion.halves = collider.deforming->now | collider.deforming->next() << 1;
    }
    return motion;
}

} // namespace voile
