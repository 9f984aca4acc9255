// Whether two transforms give a mesh the same shape.
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace voile
{

// Whether `b` differs from `a` by a turn and a translation alone: no stretch beyond rounding, no mirror image. Both are
// finite and affine.
inline bool same_shape(const glm::mat4& a, const glm::mat4& b)
{
    constexpr double k_tolerance = 1e-5; // rounding of a rotation, and of its product with a scale
    if (glm::mat3(a) == glm::mat3(b))
        return true;
    const glm::dmat3 turn = glm::dmat3(b) * glm::inverse(glm::dmat3(a));
    const glm::dmat3 product = glm::transpose(turn) * turn;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(product[column][row] - (column == row ? 1 : 0)) <= k_tolerance))
                return false;
    return glm::determinant(turn) > 0;
}

} // namespace voile
