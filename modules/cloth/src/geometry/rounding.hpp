// Doubles as floats, where what rounding takes away is kept as well.
#pragma once

#include <glm/glm.hpp>

namespace voile
{

// The nearest floats. Volatile: where GCC 12 vectorizes a conversion to float and back it leaves the rounding out, and
// the difference from the double is 0.
inline glm::vec3 rounded(const glm::dvec3& x)
{
    glm::vec3 result;
    for (int axis = 0; axis < 3; ++axis)
    {
        const volatile float nearest = static_cast<float>(x[axis]);
        result[axis] = nearest;
    }
    return result;
}

} // namespace voile
