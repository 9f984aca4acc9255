// Outputs: vertex buffers of the host's that cloths write, and what the vertex streams have on request.
#pragma once

#include "voile/ids.hpp"
#include "voile/output.hpp"
#include "voile/solver.hpp"

#include "solver/device_state.hpp"

#include "shared/output_layout.h"

namespace voile
{

struct OutputSet
{
    gpu::BindingPool pool; // of this set alone
    VkDescriptorSet set = VK_NULL_HANDLE;
};

struct Output
{
    ClothId cloth;
    VkBuffer buffer = VK_NULL_HANDLE; // the host's
    VkDeviceSize offset = 0;          // bytes, of the range that is bound
    VkDeviceSize bytes = 0;
    shared::OutputPush push{};
    OutputSet set; // none before the first upload
};

// Errors: usages that the device does not have.
Result<void> check_output(const gpu::Context& context, const OutputOptions& options);

// Whether the vertex streams have device addresses.
bool wants_addresses(const OutputOptions& options);

// The sets of all outputs, in their order, for the buffers after `growth`; none if nothing grows. Errors: out of
// memory.
Result<std::vector<OutputSet>> write_outputs(const Solver::State& solver, const Growth& growth);

} // namespace voile
