// ShaderInterface: what a compute shader binds and takes, read from its SPIR-V.
#pragma once

#include "voile/export.hpp"
#include "voile/result.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voile::gpu
{

// A storage buffer or a uniform buffer of descriptor set 0. Kernels read some storage buffers as uniform texel buffers
// on devices where that is faster (Context::texel_reads).
struct ShaderBinding
{
    uint32_t number = 0;
    std::string name;     // of its block; empty where names were stripped
    bool read = false;    // as declared: a "writeonly" buffer is not read,
    bool written = false; // and a "readonly" one is not written
    uint32_t stride =
        0; // bytes per entry of the array that it ends with; 0: it ends with none. Of a uniform buffer all
    bool uniform = false;
    uint32_t texel_bytes = 0; // 4, 8 or 16: a uniform texel buffer, R32_UINT, R32G32_UINT or R32G32B32A32_UINT; 0: none
};

struct ShaderConstant
{
    uint32_t id = 0;
    std::string name; // empty where names were stripped
};

// The value of a specialization constant.
struct SpecializationConstant
{
    uint32_t id = 0;
    uint32_t value = 0;
};

struct ShaderInterface
{
    std::vector<ShaderBinding> bindings;   // ascending by number
    std::vector<ShaderConstant> constants; // the specialization constants, ascending by id
    uint32_t push_bytes = 0;               // size of the push-constant block; 0: none
    uint64_t shared_bytes = 0; // of all variables of a workgroup, each as std430 lays it out: what an implementation
                               // takes, or a little more
};

// `spirv` must be valid. `specialization` decides the sizes of shared arrays. Names serve messages alone: everything
// else survives their removal. Errors: a descriptor that is no buffer of set 0.
VOILE_GPU_API Result<ShaderInterface> reflect(std::span<const uint32_t> spirv,
                                              std::span<const SpecializationConstant> specialization);

} // namespace voile::gpu
