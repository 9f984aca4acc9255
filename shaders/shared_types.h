// Types of the headers that both GLSL and C++ compile. In C++ they are GLM's, in namespace NAME::shared.
// Structs there are written so that std430 (and std140 for uniforms) lays them out as C++ does: a vec3 starts at a
// multiple of 16 bytes and a scalar follows it. The shader compiler can then read 16 bytes at a time.
//
// Functions of these headers are VOILE_INLINE. A `real` is a float in GLSL and a double in C++. Constants that both
// languages use are macros with the prefix VOILE_; those of one language are `const` with the prefix k_.
#ifndef VOILE_SHARED_TYPES_H
#define VOILE_SHARED_TYPES_H

#ifdef __cplusplus
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
namespace voile::shader_types
{
using real = double;
using uint = uint32_t;
using glm::floatBitsToUint;
using glm::uintBitsToFloat;
using std::abs;
using std::max;
using std::min;
using std::sqrt;
using ivec2 = glm::ivec2;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using mat4 = glm::mat4;
} // namespace voile::shader_types
#define VOILE_SHARED_BEGIN(name)                                                                                       \
    namespace name::shared                                                                                             \
    {                                                                                                                  \
    using namespace voile::shader_types;
#define VOILE_SHARED_END }
#define VOILE_INLINE inline
#else
#define real float
#define VOILE_INLINE
#define VOILE_SHARED_BEGIN(name)
#define VOILE_SHARED_END
#endif

#endif
