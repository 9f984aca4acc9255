// Specialization: the specialization constants of the kernels, by name.
#pragma once

#include "shared/bindings.h"

#include "voile/gpu/shader_interface.hpp"

#include <optional>
#include <vector>

namespace voile
{

// A kernel is given a value for each constant that its shader declares, and for no other: gpu::reflect refuses the
// rest.
struct Specialization
{
#define VOILE_CONSTANT(number, name) std::optional<uint32_t> name{};
    VOILE_CONSTANTS
#undef VOILE_CONSTANT

    [[nodiscard]] std::vector<gpu::SpecializationConstant> values() const
    {
        std::vector<gpu::SpecializationConstant> values;
#define VOILE_CONSTANT(number, name)                                                                                   \
    if (name)                                                                                                          \
        values.push_back({number, *name});
        VOILE_CONSTANTS
#undef VOILE_CONSTANT
        return values;
    }
};

} // namespace voile
