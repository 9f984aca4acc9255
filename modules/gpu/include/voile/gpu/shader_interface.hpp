// ShaderInterface: what a compute shader binds and takes, read from its SPIR-V.
#pragma once

#include "voile/export.hpp"
#include "voile/result.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voile::gpu
{

// A storage buffer or a uniform buffer of descriptor set 0. On devices where that is faster (Context::texel_reads),
// kernels read what they do not write of storage buffers as uniform texel buffers.
struct ShaderBinding
{
    uint32_t number = 0;
    std::string name;     // of its block; empty where names were stripped
    bool read = false;    // as declared: a "writeonly" buffer is not read,
    bool written = false; // and a "readonly" one is not written
    uint32_t stride =
        0; // bytes per entry of the array that it ends with; 0: it ends with none. Of a uniform buffer all
    bool uniform = false;
    uint32_t texel_bytes = 0;  // 4 (R32_UINT), 8 (R32G32_UINT) or 16 (R32G32B32A32_UINT); 0: no texels are read
    uint32_t texel_number = 0; // of their binding, if there are any; `number`: there is no storage buffer
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
    uint32_t push_bytes = 0;               // size of the push-constant block, a multiple of 4; 0: none
    std::array<uint32_t, 3> workgroup{1, 1, 1};
    uint64_t shared_bytes = 0; // of all variables of a workgroup, each as std430 lays it out: what an implementation
                               // takes, or a little more
};

// `spirv` must be valid, of any version. `specialization` decides the sizes of shared arrays and of the workgroup.
// Names serve messages alone: everything else survives their removal. Errors: no compute entry point "main"; a
// descriptor that is no buffer of set 0, or an array of buffers; two of one number.
VOILE_GPU_API Result<ShaderInterface> reflect(std::span<const uint32_t> spirv,
                                              std::span<const SpecializationConstant> specialization);

} // namespace voile::gpu
