// The vectors and matrices of the interface: GLM's, always tightly packed. Public structs have the same layout whatever
// GLM settings the host uses (such as GLM_FORCE_DEFAULT_ALIGNED_GENTYPES). With GLM's defaults Vec3 is glm::vec3.
// Otherwise GLM converts single values, and the host copies arrays: passing an array of another layout does not
// compile.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace voile
{

using Vec2 = glm::vec<2, float, glm::packed_highp>;
using Vec3 = glm::vec<3, float, glm::packed_highp>;
using Vec4 = glm::vec<4, float, glm::packed_highp>;
using DVec3 = glm::vec<3, double, glm::packed_highp>;
using UVec3 = glm::vec<3, uint32_t, glm::packed_highp>;
using Mat4 = glm::mat<4, 4, float, glm::packed_highp>; // column by column

static_assert(sizeof(Vec2) == 8 && alignof(Vec2) == 4);
static_assert(sizeof(Vec3) == 12 && alignof(Vec3) == 4);
static_assert(sizeof(Vec4) == 16 && alignof(Vec4) == 4);
static_assert(sizeof(DVec3) == 24 && alignof(DVec3) == alignof(double));
static_assert(sizeof(UVec3) == 12 && alignof(UVec3) == 4);
static_assert(sizeof(Mat4) == 64 && alignof(Mat4) == 4);

} // namespace voile
