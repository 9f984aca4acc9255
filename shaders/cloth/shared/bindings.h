// Numbers of bindings and specialization constants, the same in every kernel. GLSL writes
//   layout(VOILE_BINDING(cloths)) readonly buffer Cloths { ClothRecord cloths[]; };
//   layout(constant_id = k_constant_near_lists) const uint NEAR_LISTS = 1;
// and C++ uses binding::cloths, buffer::cloths, and a Specialization (colliders/specialization.hpp).
#ifndef VOILE_BINDINGS_H
#define VOILE_BINDINGS_H

// VOILE_CONSTANT(number, name). Number 0 is the workgroup size in x by convention.
#define VOILE_CONSTANTS                                                                                                \
    VOILE_CONSTANT(0, workgroup_size)                                                                                  \
    VOILE_CONSTANT(1, contact_method)                                                                                  \
    VOILE_CONSTANT(2, interleaved)                                                                                     \
    VOILE_CONSTANT(3, colliders_move)                                                                                  \
    VOILE_CONSTANT(4, colliders_convex)                                                                                \
    VOILE_CONSTANT(5, near_lists)                                                                                      \
    VOILE_CONSTANT(6, from_leaves)                                                                                     \
    VOILE_CONSTANT(7, pairs)                                                                                           \
    VOILE_CONSTANT(8, force_threads)                                                                                   \
    VOILE_CONSTANT(9, force_parts)                                                                                     \
    VOILE_CONSTANT(10, fewer_rounds)                                                                                   \
    VOILE_CONSTANT(11, feature_part)                                                                                   \
    VOILE_CONSTANT(12, frame_of_one)

#ifdef __cplusplus

#include <cstdint>

// The buffers that a solver owns.
namespace voile::buffer
{
enum Name : uint32_t
{
#define VOILE_BUFFER(number, name, entry, count, meaning) name = (number),
#define VOILE_SOLVER_BUFFER(number, name, entry, meaning) name = (number),
#include "buffers.h"
};
constexpr uint32_t k_numbers = 128; // the first number of a role
} // namespace voile::buffer

// The bindings that a kernel can declare: a buffer by its own name, or a role.
namespace voile::binding
{
enum Name : uint32_t
{
#define VOILE_BUFFER(number, name, entry, count, meaning) name = (number),
#define VOILE_SOLVER_BUFFER(number, name, entry, meaning) name = (number),
#define VOILE_ROLE(number, name, entry, meaning) name = (number),
#include "buffers.h"
};
} // namespace voile::binding

#else

#define VOILE_BUFFER(number, name, entry, count, meaning) const int k_binding_##name = number;
#define VOILE_SOLVER_BUFFER(number, name, entry, meaning) const int k_binding_##name = number;
#define VOILE_ROLE(number, name, entry, meaning) const int k_binding_##name = number;
#include "buffers.h"

#define VOILE_BINDING(name) set = 0, binding = k_binding_##name, std430
#define VOILE_UNIFORM_BINDING(name) set = 0, binding = k_binding_##name, std140

#define VOILE_CONSTANT(number, name) const int k_constant_##name = number;
VOILE_CONSTANTS
#undef VOILE_CONSTANT

#endif

#endif
