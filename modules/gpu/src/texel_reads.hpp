// texel_reads: reads of storage buffers as fetches of texels.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace voile::gpu
{

// A compute shader that reads some of its storage buffers as uniform texel buffers, with the same bits.
struct TexelReads
{
    std::vector<uint32_t> spirv;
    std::map<uint32_t, uint32_t> texel_bytes; // by number of the binding: 4 (R32_UINT), 8 (R32G32_UINT) or 16
};

// llvmpipe 22.3 loads each component for each thread by itself, with a branch and through memory, but a texel as a
// vector (bench/NOTES.md, "Texels on llvmpipe"). So that kernels need no second form, this changes their SPIR-V. It
// takes the buffers that are "readonly" blocks of one array, and that functions do nothing with but load what an access
// chain leads to, in types of 32 bits laid out so that no scalar or vector lies in two texels. It leaves others as they
// are. `spirv` must be valid.
TexelReads texel_reads(std::span<const uint32_t> spirv);

} // namespace voile::gpu
