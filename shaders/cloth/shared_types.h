// Types of the headers that GLSL and C++ compile alike. In C++ they are GLM's, in namespace cloth::shared.
// Structs here are laid out with GLSL's scalar layout, which is C++'s natural layout for these types.
#ifndef VOILE_SHARED_TYPES_H
#define VOILE_SHARED_TYPES_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#include <cstdint>
namespace cloth::shared
{
using uint = uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using vec4 = glm::vec4;
using uvec2 = glm::uvec2;
using uvec4 = glm::uvec4;
} // namespace cloth::shared
#define VOILE_SHARED_BEGIN                                                                                             \
    namespace cloth::shared                                                                                            \
    {
#define VOILE_SHARED_END }
#else
#define VOILE_SHARED_BEGIN
#define VOILE_SHARED_END
#endif

#endif
