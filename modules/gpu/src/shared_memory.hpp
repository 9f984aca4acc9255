// The shared memory of a compute shader, read from its SPIR-V.
#pragma once

#include <cstdint>
#include <span>

namespace voile::gpu
{

// Bytes of all variables in the Workgroup storage class, each as std430 would lay it out: what an implementation takes,
// or a little more. `specialization` are the values of constant_id 0, 1, ... The SPIR-V must be valid.
uint64_t shared_memory_bytes(std::span<const uint32_t> spirv, std::span<const uint32_t> specialization);

} // namespace voile::gpu
