// texel_reads: reads of storage buffers as fetches of texels.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace voile::gpu
{

// The uniform texel buffer that a storage buffer is read as.
struct TexelBinding
{
    uint32_t number = 0;      // of its binding: that of the storage buffer whose place it takes, or a new one
    uint32_t texel_bytes = 0; // 4 (R32_UINT), 8 (R32G32_UINT) or 16 (R32G32B32A32_UINT)
};

// A compute shader that reads some of its storage buffers as uniform texel buffers, with the same bits.
struct TexelReads
{
    std::vector<uint32_t> spirv;               // empty: there is nothing to read so
    std::map<uint32_t, TexelBinding> bindings; // by number of the storage buffer's binding
};

// llvmpipe 22.3 loads each component for each thread by itself, with a branch and through memory, but a texel as a
// vector (bench/NOTES.md, "Texels on llvmpipe"). So that kernels need no second form, this changes their SPIR-V. It
// takes what functions load of the array that a storage buffer ends with, if they never write it: all of a buffer, or
// members of its entries while they write others. Its types have 32 bits and are laid out so that no scalar or vector
// lies in two texels. No other binding of the shader may write the same memory. `spirv` must be valid.
TexelReads texel_reads(std::span<const uint32_t> spirv);

} // namespace voile::gpu
